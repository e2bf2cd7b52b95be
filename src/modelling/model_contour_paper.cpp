#include "gfp/modelling/model_contour_paper.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/memory/object_points.hpp"
#include "gfp/modelling/evaluate_fit.hpp"
#include "gfp/modelling/superquadric.hpp"
#include "modelling/model_of_placement.hpp"
#include "modelling/paper_contour.hpp"
#include "modelling/volume_model.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The scene's points with their field.
struct SceneDensity {
  std::vector<Vector3f> points;
  PointCount count;
};

/// The distance between neighbouring readings at the points' median depth, metres.
double point_spacing(const ObjectView& view, const std::vector<Vector3f>& points) {
  std::vector<float> depths;
  for (const auto& p : points) depths.push_back(p.z());
  if (depths.empty()) return 1 / view.camera.fx;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle) / view.camera.fx;
}

SceneDensity scene_density(const ObjectView& view, const PaperContourOptions& options) {
  SceneDensity scene{object_points(view), {}};
  const auto radius = static_cast<float>(options.density_radius_spacings * point_spacing(view, scene.points));
  scene.count = options.kd_tree ? count_by_kd_tree(scene.points, radius) : count_by_voxel_grid(scene.points, radius);
  return scene;
}

Sphere sphere_about(const std::vector<Vector3f>& points) {
  std::vector<Vector3d> doubles;
  for (const auto& p : points) doubles.push_back(p.cast<double>());
  return circumscribed_sphere(doubles);
}

/// What every contour's model has in common. `vertices` of the model are set by the caller.
void describe(const ObjectView& view, const ContourStart& start, ContourEnd end, FittedModel& model, ContourTrace* trace) {
  const Transform T_object_camera = model.T_camera_object.inverse();
  model.vertices = transformed(end.vertices, T_object_camera);
  model.evidence = evaluate_fit(view, end.vertices, model.topology->triangles, model.states);
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    if (start.is_control[i] != 0) model.states[i] |= kVertexControl;
    if (end.moved[i] != 0) model.states[i] |= kVertexMoved;
  }
  model.sigma_m = sigma_by_distance(model.vertices, model.states, std::max(0.0005, model.evidence.rms_m));
  for (const ContourStep& step : end.trace.steps) model.energies.push_back(step.energy());
  model.iterations = std::max(0, static_cast<int>(end.trace.steps.size()) - 1);
  model.converged = end.converged;
  if (trace != nullptr) *trace = std::move(end.trace);
}

/// Upright, the base's centre under the ball's centre.
Transform frame_under(const ObjectView& view, const Sphere& ball) {
  Transform T_camera_object = Transform::Identity();
  T_camera_object.linear() = view.T_camera_support.linear();
  T_camera_object.translation() = ball.centre - ball.radius * view.T_camera_support.linear().col(2);
  return T_camera_object;
}

ContourStart placed_start(const Placement& placement) {
  const Primitive& primitive = *placement.primitive;
  ContourStart start{transformed({shape(primitive, placement.size_m, placement.modes), primitive.topology->triangles}, placement.T_camera_object), {}, 0};
  for (const PointType type : primitive.topology->types) start.is_control.push_back(type == PointType::kControl ? 1 : 0);
  return start;
}

}  // namespace

FittedModel model_contour_paper(const ObjectView& view, const Placement& placement, const PaperContourOptions& options, ContourDirections directions,
                                ContourTrace* trace) {
  FittedModel model = model_of_placement(placement, directions == ContourDirections::kGrid26 ? "gfp_grid26" : "gfp_paper");
  const SceneDensity scene = scene_density(view, options);
  ContourStart start = placed_start(placement);
  start.search_m = std::min(options.search_share * circumscribed_sphere(start.mesh.vertices).radius, options.max_search_m);
  describe(view, start, run_paper_contour(start, scene.count, options, directions), model, trace);
  return model;
}

FittedModel model_placed(const ObjectView& view, const Placement& placement, const std::string& method) {
  FittedModel model = model_of_placement(placement, method);
  const ContourStart start = placed_start(placement);
  describe(view, start, {start.mesh.vertices, std::vector<std::uint8_t>(start.mesh.vertices.size(), 0), {}, placement.converged}, model, nullptr);
  return model;
}

FittedModel fit_sphere_snake(const ObjectView& view, const PaperContourOptions& options, ContourDirections directions, ContourTrace* trace) {
  constexpr double kLeastRadiusM = 0.01;
  const SceneDensity scene = scene_density(view, options);
  Sphere ball = scene.points.empty() ? Sphere{{0, 0, 1}, kLeastRadiusM} : sphere_about(scene.points);
  ball.radius = std::max(ball.radius, kLeastRadiusM);
  FittedModel model;
  model.method = "sphere_snake";
  model.class_name = "unknown";
  model.topology = superquadric_topology();
  model.T_camera_object = frame_under(view, ball);
  Superquadric sphere{Vector3d::Constant(ball.radius), 1, 1, model.T_camera_object};
  sphere.pose.translation() = ball.centre;
  const ContourStart start{{superquadric_vertices(sphere), model.topology->triangles}, std::vector<std::uint8_t>(superquadric_topology()->types.size(), 1), ball.radius};
  describe(view, start, run_paper_contour(start, scene.count, options, directions), model, trace);
  model.size_m = bounds(model.vertices).size();
  return model;
}

}  // namespace gfp
