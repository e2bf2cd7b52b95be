#include "gfp/evaluation/truth.hpp"

#include <algorithm>
#include <utility>

namespace gfp {
namespace {

// Scans and CAD models may face inwards as a whole; normals matter for signed distances and for what a camera sees.
void face_outwards(TriangleMesh& mesh) {
  if (signed_volume(mesh) >= 0) return;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

// Inner shells (the liquid of a bottle, walls inside walls) are no surface that anyone can see or touch.
SurfaceSamples keep_reachable(const SurfaceSamples& samples, const VoxelSolid& material) {
  const double step = 1.75 * material.voxel_m;  // past the voxels that the surface itself touches
  SurfaceSamples kept;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Eigen::Vector3d &point = samples.points[i], offset = step * samples.normals[i];
    if (material.contains(point + offset) && material.contains(point - offset)) continue;
    kept.points.push_back(point);
    kept.normals.push_back(samples.normals[i]);
  }
  return kept;
}

// A scan with a pinhole holds no water; closing its pinholes must not change any other mesh.
Result<FilledSolid> fill_scan(const TriangleMesh& mesh, double voxel_m) {
  constexpr double kLeakFactor = 1.2;
  auto plain = fill_solid(mesh, voxel_m);
  if (!plain) return plain;
  auto sealed = fill_solid(mesh, voxel_m, true);
  if (!sealed) return sealed;
  const bool leaks = sealed->filled.volume_m3() > kLeakFactor * plain->filled.volume_m3();
  return leaks ? sealed : plain;
}

}  // namespace

Result<TruthShape> make_truth_shape(std::string name, std::string class_name, TriangleMesh mesh, const TruthOptions& options) {
  face_outwards(mesh);
  auto solid = fill_scan(mesh, options.voxel_m);
  if (!solid) return tl::unexpected(Error{solid.error().code, name + ": " + solid.error().what});
  SurfaceSamples samples = keep_reachable(sample_surface(mesh, options.samples, options.seed), solid->material);
  if (samples.points.empty()) return failure(ErrorCode::kDegenerateGeometry, name + ": surface area 0 m^2, expected > 0");
  const double volume = filled_volume_m3(mesh, *solid);
  if (!(volume > 0)) return failure(ErrorCode::kDegenerateGeometry, name + ": filled volume " + std::to_string(volume) + " m^3, expected > 0");
  TruthShape shape;
  shape.name = std::move(name);
  shape.class_name = std::move(class_name);
  shape.tree = TriangleTree(mesh);
  shape.mesh = std::move(mesh);
  shape.samples = std::move(samples);
  shape.volume_filled_m3 = volume;
  shape.solid = std::move(*solid);
  return shape;
}

std::vector<std::uint8_t> visible_samples(const TruthShape& shape, const Transform& T_camera_object, const CameraModel& camera,
                                          const std::vector<TriangleTree>& others_camera) {
  constexpr double kSkin = 1e-4;  // metres; keeps a sample from being hidden by its own triangle
  const Eigen::Vector3d eye_object = T_camera_object.inverse().translation();
  std::vector<std::uint8_t> visible(shape.samples.points.size(), 0);
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Eigen::Vector3d& point = shape.samples.points[i];
    const Eigen::Vector3d point_camera = T_camera_object * point;
    if (point_camera.z() <= 0 || shape.samples.normals[i].dot(eye_object - point) <= 0) continue;
    const Eigen::Vector2d pixel = camera.project(point_camera);
    if (pixel.x() < -0.5 || pixel.y() < -0.5 || pixel.x() > camera.width - 0.5 || pixel.y() > camera.height - 0.5) continue;
    const Eigen::Vector3d start = point + kSkin * (eye_object - point).normalized();
    const auto hides = [&](const TriangleTree& other) { return other.blocks(T_camera_object * start, Eigen::Vector3d::Zero()); };
    visible[i] = !shape.tree.blocks(start, eye_object) && std::none_of(others_camera.begin(), others_camera.end(), hides);
  }
  return visible;
}

}  // namespace gfp
