#include "registration/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "registration/class_prior.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kScanSigmaM = 0.015;  ///< Size and place are guesses: what is only near must score better than what is far.

constexpr double kPeakSteps = 1.6;     ///< Yaws nearer than so many steps are one peak.

/// Low and high `share` quantiles of the values.
std::pair<double, double> quantile_range(std::vector<double>& values, double share) {
  const auto low = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  const auto high = static_cast<std::ptrdiff_t>(values.size()) - 1 - low;
  std::nth_element(values.begin(), values.begin() + low, values.end());
  const double low_value = values[static_cast<std::size_t>(low)];
  std::nth_element(values.begin(), values.begin() + high, values.end());
  return {low_value, values[static_cast<std::size_t>(high)]};
}

/// Extent of the rotated, scaled mean shape about its origin, along a direction, and how it depends on the logarithm of each axis' size.
struct ModelExtent {
  double low_m = 0, high_m = 0;
  Vector3d weights = Vector3d::Zero();  ///< d log(length) / d log(size), sums to 1.

  double length_m() const { return high_m - low_m; }
};

ModelExtent model_extent(const Primitive& primitive, const Eigen::Matrix3d& rotation, const Vector3d& size, const Vector3d& direction) {
  const Vector3d scaled = size.cwiseProduct(rotation.transpose() * direction);
  ModelExtent extent{1e300, -1e300};
  const Vector3d *lowest = nullptr, *highest = nullptr;
  for (const auto& p : primitive.mean) {
    const double value = scaled.dot(p);
    if (value < extent.low_m) { extent.low_m = value; lowest = &p; }
    if (value > extent.high_m) { extent.high_m = value; highest = &p; }
  }
  if (extent.length_m() > 0) extent.weights = scaled.cwiseProduct(*highest - *lowest) / extent.length_m();
  return extent;
}

PoseState initial_state(VisibleFit& fit, const ObservedExtent& extent, const Primitive& primitive, const Eigen::Matrix3d& rotation) {
  Vector3d log_size = primitive.log_size_mean;
  for (int pass = 0; pass < 2; ++pass) {  // the second pass linearises at a better size
    SizeBelief belief(primitive);
    const Vector3d size = log_size.array().exp().matrix();
    const auto observe = [&](const Vector3d& direction, double length_m, double sigma) {
      const ModelExtent model = model_extent(primitive, rotation, size, direction);
      if (model.length_m() > 1e-6 && length_m > 1e-3)
        belief.observe(model.weights, model.weights.dot(log_size) + std::log(length_m / model.length_m()), sigma);
    };
    observe(Vector3d::UnitZ(), extent.height_m, extent.height_sigma);
    // What is cut at a side is at least as wide as it is seen.
    const auto expected_width_m = [&] { return model_extent(primitive, rotation, belief.mean().array().exp().matrix(), extent.lateral).length_m(); };
    const bool cut = extent.low_open || extent.high_open;
    if (!cut || expected_width_m() < extent.width_m) observe(extent.lateral, extent.width_m, extent.width_sigma);
    log_size = belief.mean();
  }
  const Vector3d size = log_size.array().exp().matrix();
  PoseState state;
  state.T_support_object.linear() = rotation;
  state.log_size = log_size;
  state.modes.setZero(static_cast<Eigen::Index>(primitive.modes.size()));
  state.T_support_object.translation() = extent.centroid;
  state.T_support_object.translation().z() = -model_extent(primitive, rotation, size, Vector3d::UnitZ()).low_m;
  fit.pose(state);
  state.T_support_object.translation().head<2>() += fit.visible_centroid_shift().head<2>();
  if (extent.low_open != extent.high_open) {  // the end that is seen says where it is, the readings how far away
    const ModelExtent model = model_extent(primitive, rotation, size, extent.lateral);
    const double there = extent.low_open ? extent.high_m - model.high_m : extent.low_m - model.low_m;
    state.T_support_object.translation() += (there - extent.lateral.dot(state.T_support_object.translation())) * extent.lateral;
    fit.pose(state);
    state.T_support_object.translation().head<2>() += fit.overlap_shift().head<2>();
  }
  return state;
}

struct YawState {
  double yaw_steps = 0;
  ScoredState scored;
};

/// The best yaws, best first, no two of which are neighbours: a refinement leads neighbours to the same place.
void keep_peaks(std::vector<YawState>& states, int steps_around, int keep) {
  std::stable_sort(states.begin(), states.end(), [](const YawState& a, const YawState& b) { return a.scored.score < b.scored.score; });
  std::vector<YawState> peaks;
  for (YawState& state : states) {
    const bool beside = std::any_of(peaks.begin(), peaks.end(), [&](const YawState& peak) {
      return std::abs(std::remainder(state.yaw_steps - peak.yaw_steps, static_cast<double>(steps_around))) < kPeakSteps;
    });
    if (!beside) peaks.push_back(std::move(state));
    if (peaks.size() == static_cast<std::size_t>(keep)) break;
  }
  states = std::move(peaks);
}

/// Whether the first reading beside the object on this row is nearer than it, or outside the image: it may go on there.
bool goes_on(const ObservedTile& tile, int cell, int direction) {
  const int row = cell / tile.width;
  const float depth = tile.depth[static_cast<std::size_t>(cell)];
  for (int u = cell % tile.width + direction; u >= 0 && u < tile.width; u += direction) {
    const float beside = tile.depth[static_cast<std::size_t>(row * tile.width + u)];
    if (beside > 0) return beside < depth - 0.005F;
  }
  const int end = direction < 0 ? tile.rect.u0 : tile.rect.u1;
  return end <= 0 || end >= tile.camera.width;
}

/// Of the rows of object cells, the share whose end on this side may not be the object's.
double share_that_goes_on(const ObservedTile& tile, int direction) {
  int rows = 0, open = 0;
  for (std::size_t k = 0; k < tile.object_cells.size(); ++k) {
    const int cell = tile.object_cells[k], row = cell / tile.width;
    const bool last = direction < 0 ? k == 0 || tile.object_cells[k - 1] / tile.width != row
                                    : k + 1 == tile.object_cells.size() || tile.object_cells[k + 1] / tile.width != row;
    if (!last) continue;
    ++rows;
    open += goes_on(tile, cell, direction);
  }
  return rows > 0 ? static_cast<double>(open) / rows : 0.0;
}

}  // namespace

ObservedExtent observed_extent(const ObjectView& view, const ObservedTile& tile) {
  ObservedExtent extent;
  if (tile.object_cells.empty()) return extent;
  for (const int cell : tile.object_cells) extent.centroid += tile.points[static_cast<std::size_t>(cell)];
  extent.centroid /= static_cast<double>(tile.object_cells.size());
  const Vector3d sight = extent.centroid - tile.T_camera_support.inverse().translation();
  extent.azimuth_rad = std::atan2(sight.y(), sight.x());
  extent.lateral = Vector3d(-std::sin(extent.azimuth_rad), std::cos(extent.azimuth_rad), 0);
  std::vector<double> across;
  across.reserve(tile.object_cells.size());
  for (const int cell : tile.object_cells) across.push_back(extent.lateral.dot(tile.points[static_cast<std::size_t>(cell)]));
  const auto [low, high] = quantile_range(across, 0.01);
  extent.width_m = high - low + tile.pixel_m(tile.object_cells.front());
  extent.low_m = low;
  extent.high_m = high;
  constexpr double kCut = 0.5;
  const bool leftwards = extent.lateral.dot(tile.T_camera_support.linear().row(0).transpose()) < 0;
  const bool left_open = share_that_goes_on(tile, -1) > kCut, right_open = share_that_goes_on(tile, 1) > kCut;
  extent.low_open = leftwards ? right_open : left_open;
  extent.high_open = leftwards ? left_open : right_open;
  extent.height_m = view.height_m;
  if (view.top_cut) extent.height_sigma = 0.5;
  if (view.touches_border || view.occluded) extent.width_sigma = 0.4;
  return extent;
}

int distinct_yaws(const Primitive& primitive, const StablePose& pose, int steps) {
  const bool axis_is_vertical = std::abs(pose.R_support_object(2, 2)) > 0.99;
  const Symmetry& symmetry = primitive.symmetry;
  if (axis_is_vertical && symmetry.revolution) return 1;
  if (axis_is_vertical && symmetry.cyclic > 1) return std::max(1, steps / symmetry.cyclic);
  const bool half_turn = axis_is_vertical ? symmetry.mirror_x && symmetry.mirror_y : symmetry.flip_z && (symmetry.revolution || symmetry.mirror_x || symmetry.mirror_y);
  return half_turn ? std::max(1, steps / 2) : steps;
}

std::vector<ScoredState> search_yaws(VisibleFit& fit, const ObservedExtent& extent, const Primitive& primitive, int stable_pose, int yaw_steps, int keep) {
  const StablePose& pose = primitive.stable_poses[static_cast<std::size_t>(stable_pose)];
  const double step = 2 * std::numbers::pi / yaw_steps;
  const auto at_yaw = [&](double steps) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(extent.azimuth_rad + steps * step, Vector3d::UnitZ()) * pose.R_support_object;
    ScoredState scored{initial_state(fit, extent, primitive, rotation), stable_pose, 0};
    fit.pose(scored.state);
    scored.score = fit.score(kScanSigmaM);
    return scored;
  };
  const int count = distinct_yaws(primitive, pose, yaw_steps);
  std::vector<YawState> states;
  for (int k = 0; k < count; ++k) states.push_back({static_cast<double>(k), at_yaw(k)});
  keep_peaks(states, count, keep);
  if (count > 1) {  // between the steps beside the best ones
    const std::size_t peaks = states.size();
    for (std::size_t k = 0; k < peaks; ++k)
      for (const double side : {-0.5, 0.5}) states.push_back({states[k].yaw_steps + side, at_yaw(states[k].yaw_steps + side)});
    keep_peaks(states, count, keep);
  }
  std::vector<ScoredState> result;
  for (auto& [yaw, scored] : states) result.push_back(std::move(scored));
  return result;
}

}  // namespace gfp
