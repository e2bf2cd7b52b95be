#include "gfp/recognition/recognise.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/memory/observed_tile.hpp"
#include "recognition/view_descriptor.hpp"
#include "recognition/view_index.hpp"

namespace gfp {
namespace {

constexpr int kDescriptorCells = 600;
constexpr double kWorthTrying = 9.0;  ///< Log odds by which a hypothesis may trail the best.

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

/// That it is this primitive in this stable pose.
struct Belief {
  int primitive = 0, stable_pose = 0;
  double log_posterior = 0;
};

std::vector<Belief> believe(const ObjectView& view, const PrimitiveLibrary& library) {
  std::vector<Belief> beliefs;
  for (const auto& [primitive, pose, log_likelihood] : view_index(library)->likelihoods(describe(view))) {
    const double prior = library.all()[static_cast<std::size_t>(primitive)]->stable_poses[static_cast<std::size_t>(pose)].probability;
    beliefs.push_back({primitive, pose, log_likelihood + std::log(std::max(1e-3, prior))});
  }
  return beliefs;
}

/// Log posteriors sum to one.
void normalise(std::vector<Belief>& beliefs) {
  double total = 0, best = -1e300;
  for (const auto& belief : beliefs) best = std::max(best, belief.log_posterior);
  for (const auto& belief : beliefs) total += std::exp(belief.log_posterior - best);
  for (auto& belief : beliefs) belief.log_posterior -= best + std::log(total);
}

}  // namespace

std::vector<Hypothesis> recognise(const ObjectView& view, const PrimitiveLibrary& library, const RecognitionOptions& options) {
  if (view.object_pixels == 0 || library.all().empty()) return {};
  std::vector<Belief> beliefs = believe(view, library);
  if (const auto known = library.of_class(options.only_class); !known.empty())
    std::erase_if(beliefs, [&](const Belief& belief) { return std::find(known.begin(), known.end(), library.all()[static_cast<std::size_t>(belief.primitive)]) == known.end(); });
  normalise(beliefs);
  std::stable_sort(beliefs.begin(), beliefs.end(), [](const Belief& a, const Belief& b) { return a.log_posterior > b.log_posterior; });
  if (beliefs.size() > static_cast<std::size_t>(options.max_hypotheses)) beliefs.resize(static_cast<std::size_t>(options.max_hypotheses));

  std::vector<Hypothesis> hypotheses;  // a primitive's best pose comes first, so it gives the order and the prior
  for (const Belief& belief : beliefs) {
    if (belief.log_posterior < beliefs.front().log_posterior - kWorthTrying) break;
    const PrimitivePtr& primitive = library.all()[static_cast<std::size_t>(belief.primitive)];
    auto hypothesis = std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) { return h.primitive == primitive; });
    if (hypothesis == hypotheses.end()) hypothesis = hypotheses.insert(hypotheses.end(), {primitive, belief.log_posterior, {}});
    hypothesis->stable_poses.push_back(belief.stable_pose);
  }
  return hypotheses;
}

}  // namespace gfp
