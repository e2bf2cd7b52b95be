#include "gfp/recognition/train_views.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/random.hpp"
#include "gfp/core/raster.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "recognition/view_descriptor.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kViewsPerPose = 72;
constexpr int kTileSide = 36;       ///< Cells of a training view's longer side.

struct RenderedView {
  std::vector<SeenPoint> points;
  double azimuth_rad = 0;
};

std::vector<Vector3d> random_instance(const Primitive& primitive, Random& random) {
  const Eigen::Matrix3d factor = primitive.log_size_covariance.llt().matrixL();
  const Vector3d log_size = primitive.log_size_mean + factor * Vector3d(random.normal(), random.normal(), random.normal());
  std::vector<double> modes(primitive.modes.size());
  for (auto& b : modes) b = std::clamp(random.normal(), -2.0, 2.0);
  return shape(primitive, log_size.array().exp().matrix(), modes);
}

/// World = support frame; the object stands on z = 0 over the origin.
RenderedView render_view(const Primitive& primitive, const StablePose& pose, Random& random) {
  TriangleMesh mesh{random_instance(primitive, random), primitive.topology->triangles};
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), Vector3d::UnitZ()) * pose.R_support_object;
  double lowest = 1e300;
  for (auto& v : mesh.vertices) lowest = std::min(lowest, (v = rotation * v).z());
  for (auto& v : mesh.vertices) v.z() -= lowest;

  const double elevation = random.uniform(15, 70) * std::numbers::pi / 180, distance = random.uniform(0.6, 1.2);
  const Vector3d target = bounds(mesh.vertices).centre();
  Transform T_camera_support = Transform::Identity();  // looks along world +x: the azimuth is 0
  const Vector3d forward(std::cos(elevation), 0, -std::sin(elevation)), right(0, -1, 0);
  T_camera_support.linear().row(0) = right;
  T_camera_support.linear().row(1) = forward.cross(right);
  T_camera_support.linear().row(2) = forward;
  T_camera_support.translation() = -T_camera_support.linear() * (target - distance * forward);
  const std::vector<Vector3d> vertices_camera = transformed(mesh.vertices, T_camera_support);

  const CameraModel camera = default_kinect_camera();
  PixelRect rect{1 << 20, 1 << 20, -(1 << 20), -(1 << 20)};
  for (const auto& v : vertices_camera) {
    const Eigen::Vector2d p = camera.project(v);
    rect.u0 = std::min(rect.u0, static_cast<int>(p.x()));
    rect.v0 = std::min(rect.v0, static_cast<int>(p.y()));
    rect.u1 = std::max(rect.u1, static_cast<int>(p.x()) + 1);
    rect.v1 = std::max(rect.v1, static_cast<int>(p.y()) + 1);
  }
  DepthTile tile;
  tile.reset(rect, std::max(1, std::max(rect.width(), rect.height()) / kTileSide));
  rasterise(vertices_camera, mesh.triangles, camera, tile, {.cull_back = true});

  const auto normals = triangle_normals(mesh);
  const Transform T_support_camera = T_camera_support.inverse();
  RenderedView view;
  for (int cell = 0; cell < tile.width * tile.height; ++cell) {
    if (!tile.hit(cell)) continue;
    const auto c = static_cast<std::size_t>(cell);
    double z = static_cast<double>(tile.depth[c]);
    z += SensorNoise{}.sigma_m(z) * random.normal();
    const Vector3d point = T_support_camera * (camera.ray(rect.u0 + cell % tile.width * tile.step, rect.v0 + cell / tile.width * tile.step) * z);
    if (point.z() < 0.008) continue;  // segmentation takes the lowest millimetres for the table
    const Vector3d noise(random.normal(), random.normal(), random.normal());
    view.points.push_back({point, (normals[static_cast<std::size_t>(tile.triangle[c])] + 0.08 * noise).normalized()});
  }
  return view;
}

}  // namespace

TrainingViews train_views(const Primitive& primitive) {
  const Random root(0x6F7);
  TrainingViews views;
  views.descriptor_size = kDescriptorSize;
  for (std::size_t pose = 0; pose < primitive.stable_poses.size(); ++pose) {
    Random random = root.fork(pose);
    for (int k = 0; k < kViewsPerPose; ++k) {
      const RenderedView view = render_view(primitive, primitive.stable_poses[pose], random);
      if (view.points.empty()) continue;
      const ViewDescriptor descriptor = describe_view(view.points, view.azimuth_rad);
      views.stable_pose.push_back(static_cast<std::int32_t>(pose));
      views.descriptors.insert(views.descriptors.end(), descriptor.begin(), descriptor.end());
    }
  }
  return views;
}

}  // namespace gfp
