#include "gfp/registration/register_primitive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "registration/class_prior.hpp"
#include "registration/pose_search.hpp"
#include "registration/visible_fit.hpp"

// Search (coarse grid): every stable pose and yaw gets a size and a place; the best few are refined there, and the best of those on
// the fine grid. The fine grid decides.

namespace gfp {
namespace {

constexpr int kSearchCells = 300;      ///< Object cells of the search grid.
constexpr double kHopeless = 0.6;       ///< Score by which a coarse placement may trail the best and still be refined finely.
constexpr double kConvergedStep = 2e-4;///< Metres, radians and log sizes alike: well below the noise.

/// Gauss-Newton with annealed robust scale; keeps the best state seen. Returns the number of steps.
int refine(VisibleFit& fit, ScoredState& best, double coarse_m, double fine_m, int iterations, bool& converged) {
  PoseState state = best.state;
  double robust = coarse_m, damping = 1e-3;
  converged = false;
  int k = 0;
  fit.pose(state);
  for (; k < iterations; ++k) {
    const Eigen::VectorXd step = fit.step({.robust_m = robust}, damping);
    state.apply(step);
    fit.pose(state);
    const double score = fit.score();
    const bool better = score < best.score;
    if (better || robust > 1.5 * fine_m) best = {state, best.stable_pose, better ? score : best.score};
    damping = better ? std::max(1e-4, damping * 0.5) : std::min(1.0, damping * 4);
    robust = std::max(fine_m, 0.6 * robust);
    if (robust == fine_m && step.head<PoseState::kShape>().cwiseAbs().maxCoeff() < kConvergedStep) {
      converged = true;
      break;
    }
  }
  fit.pose(best.state);
  best.score = fit.score();
  return k;
}

void keep_best(std::vector<ScoredState>& states, std::size_t count) {
  std::stable_sort(states.begin(), states.end(), [](const ScoredState& a, const ScoredState& b) { return a.score < b.score; });
  if (states.size() > count) states.resize(count);
}

/// A hypothesis that names no stable pose leaves all of them open.
std::vector<int> poses_to_try(const Hypothesis& hypothesis) {
  if (!hypothesis.stable_poses.empty()) return hypothesis.stable_poses;
  std::vector<int> all(hypothesis.primitive->stable_poses.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::optional<ScoredState> warm_state(const ObjectView& view, const Primitive& primitive) {
  if (!view.warm_start || view.warm_start->class_name != primitive.class_name) return std::nullopt;
  ScoredState scored;
  scored.state.T_support_object = view.T_camera_support.inverse() * view.warm_start->T_camera_object;
  scored.state.log_size = view.warm_start->scale.array().log().matrix();
  scored.state.modes.setZero(static_cast<Eigen::Index>(primitive.modes.size()));
  for (std::size_t k = 0; k < std::min(primitive.modes.size(), view.warm_start->modes.size()); ++k)
    scored.state.modes[static_cast<Eigen::Index>(k)] = view.warm_start->modes[k];
  scored.stable_pose = view.warm_start->stable_pose;
  return scored;
}

Placement to_placement(const ObjectView& view, const PrimitivePtr& primitive, VisibleFit& fit, const ScoredState& scored, int pixels) {
  Placement placement;
  placement.primitive = primitive;
  placement.T_camera_object = view.T_camera_support * scored.state.T_support_object;
  placement.size_m = scored.state.log_size.array().exp().matrix();
  placement.modes.assign(scored.state.modes.data(), scored.state.modes.data() + scored.state.modes.size());
  placement.stable_pose = scored.stable_pose;
  const double effective_pixels = std::min(400.0, static_cast<double>(std::max(1, pixels)));
  placement.cost = scored.score + prior_energy(*primitive, scored.state.log_size, scored.state.modes) / effective_pixels;
  fit.pose(scored.state);
  fit.step({.robust_m = 0.006}, 0);
  placement.covariance = fit.information().ldlt().solve(Eigen::MatrixXd::Identity(scored.state.unknowns(), scored.state.unknowns()));
  return placement;
}

/// The yaws about the found one that explain the view as well: a hidden handle gives a range (ALGORITHM 1.6).
void find_yaw_interval(VisibleFit& fit, const PoseState& found, const Primitive& primitive, double best_score, Placement& placement) {
  const bool upright = std::abs(found.T_support_object.linear()(2, 2)) > 0.99;
  if (upright && primitive.symmetry.revolution) {
    placement.yaw_low_rad = -std::numbers::pi;
    placement.yaw_high_rad = std::numbers::pi;
    return;
  }
  constexpr double kStep = std::numbers::pi / 24;
  constexpr double kAsGood = 0.04;  ///< Of the score: about 15 effective pixels' half log likelihoods.
  const auto reach = [&](double direction) {
    for (int k = 1; k <= 24; ++k) {
      PoseState turned = found;
      turned.T_support_object.linear() = Eigen::AngleAxisd(direction * k * kStep, Eigen::Vector3d::UnitZ()) * found.T_support_object.linear();
      fit.pose(turned);
      if (fit.score() > best_score + kAsGood) return direction * (k - 0.5) * kStep;
    }
    return direction * std::numbers::pi;
  };
  placement.yaw_low_rad = reach(-1);
  placement.yaw_high_rad = reach(1);
}

}  // namespace

std::vector<Placement> register_primitive(const ObjectView& view, const Hypothesis& hypothesis, const RegistrationOptions& options) {
  const Primitive& primitive = *hypothesis.primitive;
  const ObservedTile fine_tile = observe(view, options.sample_pixels);
  VisibleFit fine(fine_tile, primitive, view.has_support);
  std::vector<ScoredState> states;
  bool converged = false;
  int iterations = 0;
  const auto refine_on_fine_grid = [&](double coarse_m, int count) {
    for (auto& scored : states) {
      fine.pose(scored.state);
      scored.score = fine.score();
      iterations = refine(fine, scored, coarse_m, 0.004, count, converged);
    }
  };

  constexpr double kStillGood = 1.2;  ///< Score up to which a warm start is trusted.
  if (auto warm = warm_state(view, primitive)) {
    states.push_back(*warm);
    refine_on_fine_grid(0.006, std::min(6, options.max_iterations));
    if (states.front().score > kStillGood && !hypothesis.stable_poses.empty()) states.clear();
  }
  if (states.empty()) {
    const ObservedTile coarse_tile = observe(view, kSearchCells);
    VisibleFit coarse(coarse_tile, primitive, view.has_support);
    const ObservedExtent extent = observed_extent(view, coarse_tile);
    for (const int pose : poses_to_try(hypothesis)) {
      auto found = search_yaws(coarse, extent, primitive, pose, options.yaw_steps);
      keep_best(found, static_cast<std::size_t>(options.keep + 1));
      states.insert(states.end(), found.begin(), found.end());
    }
    keep_best(states, static_cast<std::size_t>(2 * options.keep));
    for (auto& scored : states) refine(coarse, scored, 0.02, 0.008, 5, converged);
    keep_best(states, static_cast<std::size_t>(options.keep));
    const double best_score = states.front().score;
    std::erase_if(states, [&](const ScoredState& scored) { return scored.score > best_score + kHopeless; });
    refine_on_fine_grid(0.012, options.max_iterations);
    keep_best(states, static_cast<std::size_t>(options.keep));
  }
  std::vector<Placement> placements;
  for (const auto& scored : states) {
    placements.push_back(to_placement(view, hypothesis.primitive, fine, scored, view.object_pixels));
    placements.back().iterations = iterations;
    placements.back().converged = converged;
  }
  find_yaw_interval(fine, states.front().state, primitive, states.front().score, placements.front());
  return placements;
}

}  // namespace gfp
