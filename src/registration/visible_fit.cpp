#include "registration/visible_fit.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/core/nearest_cell.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kReach = 16;                   ///< Cells over which the model is drawn out; it is drawn in from anywhere.
constexpr double kEffectivePixels = 400;     ///< Neighbouring pixels err together: no more independent readings than this.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

double geman_mcclure(double residual, double scale) {
  const double ratio = residual / scale;
  const double denominator = 1.0 + ratio * ratio;
  return 1.0 / (denominator * denominator);
}

/// target += factor * values, over all coordinates of all points.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void add_scaled(const double* __restrict values, double factor, std::size_t count, double* __restrict target) {
  for (std::size_t k = 0; k < count; ++k) target[k] += factor * values[k];
}

/// linear (3 x 3, column by column) * point + offset, for all points.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void transform_points(const double* __restrict points, std::size_t count, const double* linear, const double* offset,
                                                                                  double* __restrict out) {
  for (std::size_t k = 0; k < count; ++k) {
    const double x = points[3 * k], y = points[3 * k + 1], z = points[3 * k + 2];
    for (std::size_t r = 0; r < 3; ++r) out[3 * k + r] = linear[r] * x + linear[3 + r] * y + linear[6 + r] * z + offset[r];
  }
}

double root_of_squares(double a, double b) { return std::sqrt(a * a + b * b); }

}  // namespace

struct VisibleFit::SurfacePoint {
  Vector3d point;                  ///< Support frame.
  std::int32_t vertices[3];
  Vector3d weights;                ///< Barycentric.
  Vector3d canonical;              ///< Deformed canonical point.
};

void PoseState::apply(const Eigen::VectorXd& step) {
  T_support_object.translation() += step.segment<3>(0);
  T_support_object.linear() = rotation_from_vector(step.segment<3>(3)) * T_support_object.linear();
  log_size += step.segment<3>(kPose);
  modes = (modes + step.tail(modes.size())).cwiseMax(-largest_mode).cwiseMin(largest_mode);
}

SearchTile::SearchTile(ObservedTile observed) : ObservedTile(std::move(observed)) {
  rim.assign(at(cells()), 0);
  const auto bare = [&](int cell) { return evidence[at(cell)] != Evidence::kObject; };
  for (const int cell : object_cells) {
    const int i = cell % width, j = cell / width;
    rim[at(cell)] = (i > 0 && bare(cell - 1)) || (i + 1 < width && bare(cell + 1)) || (j > 0 && bare(cell - width)) || (j + 1 < height && bare(cell + width));
  }
}

std::vector<SearchTile> search_tiles(const ObjectView& view, int target_cells) {
  std::vector<SearchTile> tiles;
  for (ObservedTile& observed : observe_field(view, target_cells)) tiles.emplace_back(std::move(observed));
  return tiles;
}

Vector3d VisibleFit::Rendering::point_support(int cell) const { return camera_support + tile->rays[at(cell)] * static_cast<double>(depth.depth[at(cell)]); }

VisibleFit::VisibleFit(std::span<const SearchTile> tiles, const Primitive& primitive, bool has_support)
    : primitive_(primitive), has_support_(has_support), size_information_(primitive.log_size_covariance.inverse()) {
  for (const SearchTile& tile : tiles) renderings_.push_back({&tile, tile.T_camera_support.inverse().translation(), std::vector<Vector3d>(primitive.size()), {}});
}

void VisibleFit::pose(const PoseState& state) {
  state_ = state;
  size_ = state.log_size.array().exp().matrix();
  const std::size_t count = primitive_.size();
  canonical_ = primitive_.mean;
  for (Eigen::Index k = 0; k < state.modes.size(); ++k)
    if (state.modes[k] != 0) add_scaled(primitive_.modes[at(static_cast<int>(k))].front().data(), state.modes[k], 3 * count, canonical_.front().data());
  support_linear_ = state.T_support_object.linear() * size_.asDiagonal();
  for (Rendering& seen : renderings_) {
    const SearchTile& tile = *seen.tile;
    const Eigen::Matrix3d linear = tile.T_camera_support.linear() * support_linear_;
    const Vector3d offset = tile.T_camera_support * state.T_support_object.translation();
    transform_points(canonical_.front().data(), count, linear.data(), offset.data(), seen.camera.front().data());
    seen.depth.reset(tile.rect, tile.step);
    rasterise(seen.camera, primitive_.topology->triangles, tile.camera, seen.depth, {.cull_back = true});
  }
}

double VisibleFit::score(double model_sigma_m) const {
  if (renderings_.size() == 1) return image_score(*renderings_.front().tile, renderings_.front().depth, model_sigma_m).cost;
  double sum = 0, cells = 0;
  for (const Rendering& seen : renderings_) {
    const auto count = static_cast<double>(seen.tile->object_cells.size());
    sum += count * image_score(*seen.tile, seen.depth, model_sigma_m).cost;
    cells += count;
  }
  return sum / std::max(1.0, cells);
}

Vector3d VisibleFit::support_point(std::size_t vertex) const { return support_linear_ * canonical_[vertex] + state_.T_support_object.translation(); }

Bounds VisibleFit::bounds_support() const {
  Bounds box;
  for (std::size_t i = 0; i < canonical_.size(); ++i) box.include(support_point(i));
  return box;
}

Vector3d VisibleFit::visible_centroid_shift() const {
  const Rendering& seen = renderings_.front();
  Vector3d observed = Vector3d::Zero(), modelled = Vector3d::Zero();
  int count = 0;
  for (int cell = 0; cell < seen.tile->cells(); ++cell) {
    if (!seen.depth.hit(cell)) continue;
    modelled += seen.point_support(cell);
    ++count;
  }
  for (const int cell : seen.tile->object_cells) observed += seen.tile->points[at(cell)];
  if (count == 0 || seen.tile->object_cells.empty()) return Vector3d::Zero();
  return observed / static_cast<double>(seen.tile->object_cells.size()) - modelled / static_cast<double>(count);
}

Vector3d VisibleFit::overlap_shift() const {
  const Rendering& seen = renderings_.front();
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const int cell : seen.tile->object_cells) {
    if (!seen.depth.hit(cell)) continue;
    sum += seen.tile->points[at(cell)] - seen.point_support(cell);
    ++count;
  }
  return count > 0 ? Vector3d(sum / count) : Vector3d::Zero();
}

VisibleFit::SurfacePoint VisibleFit::surface_point(const Rendering& seen, int cell) const {
  const SearchTile& tile = *seen.tile;
  const Triangle& t = primitive_.topology->triangles[at(seen.depth.triangle[at(cell)])];
  SurfacePoint result{};
  for (std::size_t k = 0; k < 3; ++k) result.vertices[k] = t[k];
  const Vector3d ray = tile.camera.ray(tile.rect.u0 + cell % tile.width * tile.step, tile.rect.v0 + cell / tile.width * tile.step);
  result.weights = barycentric_on_ray(seen.camera[at(t[0])], seen.camera[at(t[1])], seen.camera[at(t[2])], ray);
  result.point = seen.point_support(cell);
  for (int k = 0; k < 3; ++k) result.canonical += result.weights[k] * canonical_[at(result.vertices[k])];
  return result;
}

VisibleFit::SurfacePoint VisibleFit::vertex_point(std::size_t vertex) const {
  const auto v = static_cast<std::int32_t>(vertex);
  return {support_point(vertex), {v, v, v}, {1, 0, 0}, canonical_[vertex]};
}

void VisibleFit::add(const SurfacePoint& p, const Vector3d& direction, double residual, double weight) {
  const std::span<double> row = rows_.add(residual);
  weights_.push_back(weight);
  const Vector3d turned = (p.point - state_.T_support_object.translation()).cross(direction);
  const Vector3d scaled_direction = support_linear_.transpose() * direction;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    row[k] = direction[axis];
    row[3 + k] = turned[axis];
    row[PoseState::kPose + k] = scaled_direction[axis] * p.canonical[axis];
  }
  for (std::size_t k = 0; k < at(static_cast<int>(state_.modes.size())); ++k) {
    const auto& mode = primitive_.modes[k];
    row[PoseState::kShape + k] = scaled_direction.dot(p.weights[0] * mode[at(p.vertices[0])] + p.weights[1] * mode[at(p.vertices[1])] +
                                                      p.weights[2] * mode[at(p.vertices[2])]);
  }
}

void VisibleFit::add_surface_residuals(const Rendering& seen, const FitScale& scale) {
  const SearchTile& tile = *seen.tile;
  const double share = std::min(1.0, kEffectivePixels / static_cast<double>(std::max<std::size_t>(1, tile.object_cells.size())));
  for (const int cell : tile.object_cells) {
    if (!seen.depth.hit(cell)) continue;
    const double residual = plane_distance(tile, seen.depth, cell);
    const double sigma = root_of_squares(static_cast<double>(tile.sigma_m[at(cell)]), scale.model_sigma_m);
    const double weight = share * geman_mcclure(residual, scale.robust_m + 2 * sigma) / (sigma * sigma);
    Vector3d normal = tile.normals[at(cell)];
    if (normal.squaredNorm() < 0.5) normal = -tile.rays[at(cell)].normalized();
    // The rendered point is in front of the data where the residual is negative: along the normal towards the camera.
    add(surface_point(seen, cell), normal, -residual, weight);
  }
}

void VisibleFit::add_silhouette_residuals(const Rendering& seen, const FitScale& scale) {
  const SearchTile& tile = *seen.tile;
  const DepthTile& rendered = seen.depth;
  if (tile.object_cells.empty()) return;  // nothing to be drawn out or in to
  const Eigen::Matrix3d R_support_camera = tile.T_camera_support.linear().transpose();
  const double share = std::min(1.0, kEffectivePixels / static_cast<double>(std::max<std::size_t>(1, tile.object_cells.size())));

  // The model's point seen at `cell` should move sideways until it is seen at `target`.
  const auto draw = [&](int cell, int target) {
    const double du = target % tile.width - cell % tile.width, dv = target / tile.width - cell / tile.width;
    const double length = root_of_squares(du, dv);
    const double pixel = tile.step * static_cast<double>(rendered.depth[at(cell)]) / tile.camera.fx;
    const double distance = (length - 0.5) * pixel;
    const double sigma = root_of_squares(0.7 * pixel, scale.model_sigma_m);
    const double weight = share * geman_mcclure(distance, 2 * (scale.robust_m + 2 * sigma)) / (sigma * sigma);
    add(surface_point(seen, cell), R_support_camera * Vector3d(du / length, dv / length, 0), -distance, weight);
  };
  for (const int cell : tile.object_cells) {
    if (!tile.rim[at(cell)] || rendered.hit(cell)) continue;
    const int from = nearest_cell(tile.width, tile.height, cell, kReach, [&](int c) { return rendered.hit(c); });
    if (from >= 0) draw(from, cell);
  }
  for (int j = 0; j < tile.height; ++j) {
    for (int i = 0; i < tile.width; ++i) {
      const int cell = j * tile.width + i;
      if (!rendered.hit(cell) || tile.evidence[at(cell)] == Evidence::kObject || tile.depth[at(cell)] <= 0 || !in_free_space(tile, rendered, cell)) continue;
      const bool on_edge = i == 0 || j == 0 || i + 1 == tile.width || j + 1 == tile.height || !rendered.hit(cell - 1) || !rendered.hit(cell + 1) ||
                           !rendered.hit(cell - tile.width) || !rendered.hit(cell + tile.width);
      if (!on_edge) continue;
      const int to = nearest_cell(tile.width, tile.height, cell, std::max(tile.width, tile.height), [&](int c) { return tile.evidence[at(c)] == Evidence::kObject; });
      if (to >= 0) draw(cell, to);
    }
  }
}

void VisibleFit::add_contact_and_priors(const FitScale& scale) {
  if (has_support_) {
    const Vector3d upwards = support_linear_.row(2).transpose();
    std::size_t lowest = 0;
    for (std::size_t i = 1; i < canonical_.size(); ++i)
      if (upwards.dot(canonical_[i]) < upwards.dot(canonical_[lowest])) lowest = i;
    const SurfacePoint foot = vertex_point(lowest);
    add(foot, Vector3d::UnitZ(), foot.point.z(), 1.0 / (scale.contact_sigma_m * scale.contact_sigma_m));
  }
  rows_.normal_equations(weights_, information_, gradient_);
  const double tilt = has_support_ ? scale.tilt_sigma_rad : 0.35;
  information_(3, 3) += 1.0 / (tilt * tilt);
  information_(4, 4) += 1.0 / (tilt * tilt);
  information_(5, 5) += 1e-2;  // keeps the yaw of a body of revolution where it is
  information_.block<3, 3>(PoseState::kPose, PoseState::kPose) += size_information_;
  gradient_.segment<3>(PoseState::kPose) += size_information_ * (state_.log_size - primitive_.log_size_mean);
  const Eigen::Index modes = state_.modes.size();
  information_.diagonal().tail(modes).array() += 1.0;
  gradient_.tail(modes) += state_.modes;
}

Eigen::VectorXd VisibleFit::step(const FitScale& scale, double damping) {
  rows_.reset(state_.unknowns());
  weights_.clear();
  for (const Rendering& seen : renderings_) {
    add_surface_residuals(seen, scale);
    add_silhouette_residuals(seen, scale);
  }
  add_contact_and_priors(scale);
  Eigen::MatrixXd damped = information_;
  damped.diagonal() *= 1.0 + damping;
  Eigen::VectorXd downhill = -gradient_;
  // A mode at its bound that is pushed outwards does not take part: the others make up for it.
  for (Eigen::Index k = 0; k < state_.modes.size(); ++k) {
    const Eigen::Index unknown = PoseState::kShape + k;
    if (std::abs(state_.modes[k]) < state_.largest_mode || downhill[unknown] * state_.modes[k] < 0) continue;
    damped.row(unknown).setZero();
    damped.col(unknown).setZero();
    damped(unknown, unknown) = 1;
    downhill[unknown] = 0;
  }
  Eigen::VectorXd step = damped.ldlt().solve(downhill);
  // A step may not leave the neighbourhood in which the associations mean something.
  const double ratios[] = {step.head<3>().norm() / 0.03, step.segment<3>(3).norm() / 0.25, step.segment<3>(6).cwiseAbs().maxCoeff() / 0.25,
                           step.size() > PoseState::kShape ? step.tail(step.size() - PoseState::kShape).cwiseAbs().maxCoeff() / 1.5 : 0.0};
  return step / std::max(1.0, *std::max_element(std::begin(ratios), std::end(ratios)));
}

}  // namespace gfp
