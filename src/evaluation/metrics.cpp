#include "gfp/evaluation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "median.hpp"

namespace gfp {
namespace {

using Vec = Eigen::Vector3d;
constexpr int kFitSamples = 2000;
constexpr double kFscoreReach_m = 0.005;
constexpr double kSimilarityReach_m = 0.005;
constexpr double kNormalReach_m = 0.05;  // a true surface farther along the normal is another one

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::vector<double> distances(const TriangleTree& surface, std::span<const Vec> points) {
  std::vector<double> result;
  result.reserve(points.size());
  for (const Vec& point : points) result.push_back(surface.closest(point).distance_m);
  return result;
}

double share_within(const std::vector<double>& values, double reach) {
  const auto count = std::count_if(values.begin(), values.end(), [reach](double value) { return value <= reach; });
  return values.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(values.size());
}

void compare_surfaces(const TruthView& truth, const TriangleMesh& fit_object, const TriangleTree& fit_tree, FitMetrics& metrics) {
  const auto to_fit = distances(fit_tree, truth.shape->samples.points);
  const auto to_truth = distances(truth.shape->tree, sample_surface(fit_object, kFitSamples, 1).points);
  std::vector<double> seen, hidden;
  for (std::size_t i = 0; i < to_fit.size(); ++i) (truth.visible[i] ? seen : hidden).push_back(to_fit[i]);
  metrics.chamfer_m = 0.5 * (mean(to_fit) + mean(to_truth));
  metrics.hidden_chamfer_m = mean(hidden);
  metrics.observed_median_m = median(std::move(seen));
  const double recall = share_within(to_fit, kFscoreReach_m), precision = share_within(to_truth, kFscoreReach_m);
  metrics.fscore_5mm = recall + precision > 0 ? 2 * recall * precision / (recall + precision) : 0.0;
}

void compare_volumes(const TruthShape& truth, const TriangleMesh& fit_object, FitMetrics& metrics) {
  const auto solid = fill_solid(fit_object, truth.solid.filled.voxel_m);
  if (!solid) return;
  metrics.iou_filled = intersection_over_union(truth.solid.filled, solid->filled);
  metrics.iou_material = intersection_over_union(truth.solid.material, solid->material);
  metrics.volume_error = std::abs(filled_volume_m3(fit_object, *solid) - truth.volume_filled_m3) / truth.volume_filled_m3;
}

// The true error of a vertex, signed along its normal; the plain distance where the normal meets no true surface.
double error_along_normal(const TriangleTree& truth, const Vec& vertex, const Vec& normal) {
  if (const auto along = truth.crossing_along(vertex, normal, kNormalReach_m)) return *along;
  return truth.closest(vertex).distance_m;
}

void cover_sigma(const TruthShape& truth, const TriangleMesh& fit_object, const FittedModel& fit, FitMetrics& metrics) {
  if (fit.sigma_m.size() != fit_object.vertices.size() || fit.states.size() != fit_object.vertices.size()) return;
  const auto normals = vertex_normals(fit_object);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    SigmaCoverage& coverage = (fit.states[i] & kVertexObserved) != 0 ? metrics.sigma_observed : metrics.sigma_inferred;
    const double error = error_along_normal(truth.tree, fit_object.vertices[i], normals[i]);
    coverage.within += std::abs(error) <= static_cast<double>(fit.sigma_m[i]) ? 1 : 0;
    ++coverage.vertices;
  }
}

std::optional<double> yaw_error(const TruthView& truth, const FittedModel& fit) {
  if (!truth.shape->yaw_period_rad || fit.class_name != truth.shape->class_name) return std::nullopt;
  const Eigen::Matrix3d turn = (truth.T_camera_object.inverse() * fit.T_camera_object).linear();
  const double yaw = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
  return std::abs(std::remainder(yaw, *truth.shape->yaw_period_rad));
}

bool usable(const TriangleMesh& mesh) {
  return !mesh.triangles.empty() && std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec& v) { return v.allFinite(); });
}

}  // namespace

double fit_similarity(const TriangleTree& surface, std::span<const Vec> points) {
  double sum = 0;
  for (const Vec& point : points) {
    const double relative = surface.closest(point).distance_m / kSimilarityReach_m;
    sum += 1.0 / (1.0 + relative * relative);
  }
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

FitMetrics measure_fit(const TruthView& truth, const FittedModel& fit, std::span<const Vec> points_camera) {
  const Transform T_object_camera = truth.T_camera_object.inverse();
  std::vector<Vec> points_object;
  const std::size_t stride = points_camera.size() / static_cast<std::size_t>(kSimilarityPoints) + 1;
  for (std::size_t i = 0; i < points_camera.size(); i += stride) points_object.push_back(T_object_camera * points_camera[i]);

  FitMetrics metrics;
  metrics.fit_similarity_true = fit_similarity(truth.shape->tree, points_object);
  const TriangleMesh mesh = fit.topology ? transformed(fit.mesh_camera(), T_object_camera) : TriangleMesh{};
  if (!usable(mesh)) return metrics;
  const TriangleTree tree(mesh);
  compare_volumes(*truth.shape, mesh, metrics);
  compare_surfaces(truth, mesh, tree, metrics);
  metrics.fit_similarity = fit_similarity(tree, points_object);
  metrics.closed = examine_topology(mesh).closed;
  metrics.self_intersections = count_self_intersections(mesh, 1000);
  cover_sigma(*truth.shape, mesh, fit, metrics);
  metrics.yaw_error_rad = yaw_error(truth, fit);
  return metrics;
}

}  // namespace gfp
