#include "gfp/recognition/recognise.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "gfp/memory/observed_tile.hpp"
#include "recognition/view_descriptor.hpp"
#include "recognition/view_index.hpp"

namespace gfp {
namespace {

constexpr int kDescriptorCells = 600;
constexpr double kPoseWorthTrying = 5.0;  ///< Log likelihood by which a stable pose may trail the class's best.

ViewDescriptor describe(const ObjectView& view) {
  const ObservedTile tile = observe(view, kDescriptorCells);
  std::vector<SeenPoint> points;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const int cell : tile.object_cells) {
    const auto c = static_cast<std::size_t>(cell);
    points.push_back({tile.points[c], tile.normals[c]});
    centroid += tile.points[c] / static_cast<double>(tile.object_cells.size());
  }
  const Eigen::Vector3d sight = centroid - tile.T_camera_support.inverse().translation();
  return describe_view(points, std::atan2(sight.y(), sight.x()));
}

struct ClassBelief {
  double log_posterior = -1e300;
  std::vector<std::pair<double, int>> poses;  ///< (log posterior, stable pose)
};

Hypothesis to_hypothesis(const PrimitivePtr& primitive, ClassBelief belief) {
  std::sort(belief.poses.begin(), belief.poses.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  Hypothesis hypothesis{primitive, belief.log_posterior, {}};
  for (const auto& [log_posterior, pose] : belief.poses)
    if (log_posterior > belief.poses.front().first - kPoseWorthTrying) hypothesis.stable_poses.push_back(pose);
  return hypothesis;
}

}  // namespace

std::vector<Hypothesis> recognise(const ObjectView& view, const PrimitiveLibrary& library, const RecognitionOptions& options) {
  if (view.object_pixels == 0 || library.all().empty()) return {};
  std::vector<ClassBelief> beliefs(library.all().size());
  for (const auto& [primitive, pose, log_likelihood] : view_index(library)->likelihoods(describe(view))) {
    auto& belief = beliefs[static_cast<std::size_t>(primitive)];
    const double prior = library.all()[static_cast<std::size_t>(primitive)]->stable_poses[static_cast<std::size_t>(pose)].probability;
    const double log_posterior = log_likelihood + std::log(std::max(1e-3, prior));
    belief.poses.emplace_back(log_posterior, pose);
    belief.log_posterior = std::max(belief.log_posterior, log_posterior);
  }
  const PrimitivePtr known = options.only_class.empty() ? nullptr : library.find(options.only_class);
  double total = 0, best = -1e300;
  for (const auto& belief : beliefs) best = std::max(best, belief.log_posterior);
  for (const auto& belief : beliefs) total += std::exp(belief.log_posterior - best);
  std::vector<Hypothesis> hypotheses;
  for (std::size_t p = 0; p < beliefs.size(); ++p) {
    if (beliefs[p].poses.empty() || (known && library.all()[p] != known)) continue;
    hypotheses.push_back(to_hypothesis(library.all()[p], beliefs[p]));
    hypotheses.back().log_prior -= best + std::log(total);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.log_prior > b.log_prior; });
  if (hypotheses.size() > static_cast<std::size_t>(options.max_hypotheses)) hypotheses.resize(static_cast<std::size_t>(options.max_hypotheses));
  return hypotheses;
}

}  // namespace gfp
