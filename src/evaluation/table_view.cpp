#include "table_view.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "gfp/core/random.hpp"
#include "gfp/simulation/virtual_camera.hpp"
#include "occluder.hpp"

namespace gfp {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kFirstAzimuth = -0.5 * std::numbers::pi;

Image<std::uint8_t> mask_of(const Image<std::int32_t>& labels, std::int32_t object) {
  Image<std::uint8_t> mask(labels.width, labels.height, 0);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = labels.pixels[i] == object ? 255 : 0;
  return mask;
}

std::string view_name(const TableViewpoint& viewpoint) {
  char text[48];
  std::snprintf(text, sizeof text, "e%.0f y%.0f", viewpoint.elevation_deg, viewpoint.yaw_deg);
  return text;
}

}  // namespace

EvaluationCase make_table_case(const std::shared_ptr<const TruthShape>& shape, const TableViewpoint& viewpoint, const CaseOptions& options, std::uint64_t seed) {
  const CameraModel camera = default_kinect_camera();
  const Eigen::Vector3d target(0, 0, 0.5 * bounds(shape->mesh.vertices).high.z());
  const Transform T_world_camera = look_at_pose(target, options.distance_m, viewpoint.elevation_deg * kRadians, kFirstAzimuth);

  VirtualScene scene;
  PlacedMesh object{shape->name, shape->class_name, shape->mesh, Transform::Identity(), {200, 200, 190}};
  object.T_world_object.linear() = Eigen::AngleAxisd(viewpoint.yaw_deg * kRadians, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scene.objects.push_back(std::move(object));

  EvaluationCase result;
  std::vector<TriangleTree> others;
  if (options.occlusion > 0) {
    Occluder occluder = place_occluder(scene.objects.front(), camera, T_world_camera, options.occlusion, (seed & 1U) != 0);
    result.hidden_share = occluder.hidden_share;
    const TriangleMesh box_camera = transformed(occluder.box.mesh, T_world_camera.inverse() * occluder.box.T_world_object);
    append_surface_points(box_camera, result.others_camera);
    others.emplace_back(box_camera);
    scene.objects.push_back(std::move(occluder.box));
  }
  VirtualCameraOptions sensor;
  sensor.noise_scale = options.noise_scale;
  Capture shot = capture(scene, camera, T_world_camera, sensor, seed);
  result.frame = std::move(shot.frame);
  result.object_mask = mask_of(shot.truth.labels, 0);
  result.T_camera_support = T_world_camera.inverse();
  result.truth.shape = shape;
  result.truth.T_camera_object = shot.truth.T_camera_object.front();
  result.truth.visible = visible_samples(*shape, result.truth.T_camera_object, camera, others);
  for (int k = 1; k < options.cameras; ++k) {
    const double azimuth = kFirstAzimuth + 2 * std::numbers::pi * k / options.cameras;
    Capture other = capture(scene, camera, look_at_pose(target, options.distance_m, viewpoint.elevation_deg * kRadians, azimuth), sensor, seed + static_cast<std::uint64_t>(k));
    result.elsewhere.push_back({std::move(other.frame), mask_of(other.truth.labels, 0)});
  }
  return result;
}

void add_table_cases(const std::string& source, const std::shared_ptr<const TruthShape>& shape, const CaseOptions& options,
                     std::uint64_t index, std::vector<CaseSpec>& specs) {
  Random random = Random(options.seed).fork(index);
  for (const double elevation : options.elevations_deg) {
    const double offset = random.uniform();
    for (int k = 0; k < options.views; ++k) {
      const TableViewpoint viewpoint{elevation, 360.0 * (k + offset) / options.views};
      const std::uint64_t seed = random.next();
      specs.push_back({source, shape->name, view_name(viewpoint), shape->class_name,
                       [shape, viewpoint, options, seed]() -> Result<EvaluationCase> { return make_table_case(shape, viewpoint, options, seed); }});
    }
  }
}

}  // namespace gfp
