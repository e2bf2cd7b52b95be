#include "cli/painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace gfp {
namespace {

constexpr double kNearM = 0.05;
constexpr double kHiddenM = 0.015;  // a reading this much nearer stands before the mesh
constexpr Rgb8 kWhite{255, 255, 255};

/// Which mesh and triangle a z-buffer's running index means.
struct Owner {
  std::size_t mesh = 0;
  std::size_t triangle = 0;
};

std::vector<std::int32_t> first_indices(const std::vector<PaintedMesh>& meshes) {
  std::vector<std::int32_t> first{0};
  for (const PaintedMesh& m : meshes) first.push_back(first.back() + static_cast<std::int32_t>(m.mesh.triangles.size()));
  return first;
}

Owner owner_of(std::int32_t index, const std::vector<std::int32_t>& first) {
  const auto above = std::upper_bound(first.begin(), first.end(), index);
  const auto mesh = static_cast<std::size_t>(above - first.begin() - 1);
  return {mesh, static_cast<std::size_t>(index - first[mesh])};
}

bool is_observed(const PaintedMesh& m, const Triangle& t) {
  if (m.observed.empty()) return true;
  int seen = 0;
  for (const std::int32_t corner : t) seen += m.observed[static_cast<std::size_t>(corner)];
  return seen >= 2;
}

/// A lamp at the camera, a little above it.
double brightness(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d to_lamp = Eigen::Vector3d(0.2, -0.5, -0.85).normalized();
  return 0.45 + 0.65 * std::abs(normal.dot(to_lamp));
}

}  // namespace

PaintedMesh painted(const FittedModel& model, const Transform& T_view_camera, Rgb8 color) {
  PaintedMesh result{transformed(model.mesh_object(), T_view_camera * model.T_camera_object), {}, color};
  for (const std::uint8_t state : model.states) result.observed.push_back((state & kVertexObserved) != 0);
  if (result.observed.size() != result.mesh.vertices.size()) result.observed.clear();
  return result;
}

void Painter::meshes(const std::vector<PaintedMesh>& meshes, double alpha, const Image<float>& measured_m) {
  DepthTile tile;
  tile.reset({0, 0, canvas_.width(), canvas_.height()}, 1);
  const std::vector<std::int32_t> first = first_indices(meshes);
  for (std::size_t m = 0; m < meshes.size(); ++m)
    rasterise(meshes[m].mesh.vertices, meshes[m].mesh.triangles, camera_, tile, {first[m], kNearM});
  shade(meshes, tile, alpha, measured_m);
  for (const PaintedMesh& mesh : meshes) wireframe(mesh, tile);
}

void Painter::shade(const std::vector<PaintedMesh>& meshes, const DepthTile& tile, double alpha, const Image<float>& measured_m) {
  const std::vector<std::int32_t> first = first_indices(meshes);
  std::vector<std::vector<Eigen::Vector3d>> normals;
  for (const PaintedMesh& m : meshes) normals.push_back(triangle_normals(m.mesh));
  const auto mesh_at = [&](int u, int v) {
    if (u < 0 || v < 0 || u >= tile.width || v >= tile.height) return std::ptrdiff_t{-1};
    const std::int32_t index = tile.triangle[static_cast<std::size_t>(v * tile.width + u)];
    return index < 0 ? std::ptrdiff_t{-1} : static_cast<std::ptrdiff_t>(owner_of(index, first).mesh);
  };
  for (int v = 0; v < tile.height; ++v) {
    for (int u = 0; u < tile.width; ++u) {
      const auto cell = static_cast<std::size_t>(v * tile.width + u);
      if (tile.triangle[cell] < 0) continue;
      const Owner owner = owner_of(tile.triangle[cell], first);
      const PaintedMesh& m = meshes[owner.mesh];
      const float measured = measured_m.empty() ? 0.0F : measured_m.at(u, v);
      const bool hidden = measured > 0 && tile.depth[cell] > measured + static_cast<float>(kHiddenM);
      const bool observed = is_observed(m, m.mesh.triangles[owner.triangle]);
      const bool stripe = !observed && (u + v) % 10 < 4;
      const Rgb8 color = shaded(stripe ? kWhite : m.color, brightness(normals[owner.mesh][owner.triangle]));
      canvas_.blend(u, v, color, hidden ? 0.3 * alpha : alpha);
      const auto self = static_cast<std::ptrdiff_t>(owner.mesh);
      const bool edge = mesh_at(u - 2, v) != self || mesh_at(u + 2, v) != self || mesh_at(u, v - 2) != self || mesh_at(u, v + 2) != self;
      if (edge) canvas_.blend(u, v, m.color, hidden ? 0.5 : 1.0);
    }
  }
}

void Painter::wireframe(const PaintedMesh& m, const DepthTile& tile) {
  constexpr double kVisibleM = 0.002;
  const auto visible = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d pixel = camera_.project(p);
    const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
    if (u < 0 || v < 0 || u >= tile.width || v >= tile.height) return false;
    return p.z() <= static_cast<double>(tile.depth[static_cast<std::size_t>(v * tile.width + u)]) + kVisibleM;
  };
  for (const Triangle& t : m.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      if (a > b) continue;  // the neighbour draws it
      const Eigen::Vector3d& p = m.mesh.vertices[static_cast<std::size_t>(a)];
      const Eigen::Vector3d& q = m.mesh.vertices[static_cast<std::size_t>(b)];
      if (p.z() > kNearM && q.z() > kNearM && visible(p) && visible(q) && visible(0.5 * (p + q))) line(p, q, shaded(m.color, 0.35), 1, 0.35);
    }
  }
}

void Painter::line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb8 color, double thickness_px, double alpha) {
  Eigen::Vector3d a = from, b = to;
  if (a.z() < b.z()) std::swap(a, b);
  if (!(a.z() > kNearM)) return;
  if (b.z() < kNearM) b = a + (a.z() - kNearM) / (a.z() - b.z()) * (b - a);
  canvas_.line(camera_.project(a), camera_.project(b), color, thickness_px, alpha);
}

void Painter::dot(const Eigen::Vector3d& point, double radius_px, Rgb8 color, double alpha) {
  if (point.z() > kNearM) canvas_.disc(camera_.project(point), radius_px, color, alpha);
}

void Painter::support(const SupportPlane& plane, const Transform& T_view_camera, Rgb8 color) {
  const Transform T_view_support = T_view_camera * plane.T_camera_support;
  const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
    const Eigen::Vector2d& xy = plane.polygon[i % plane.polygon.size()];
    return T_view_support * Eigen::Vector3d(xy.x(), xy.y(), 0);
  };
  for (std::size_t i = 0; i < plane.polygon.size(); ++i) line(corner(i), corner(i + 1), color, 2, 0.9);
}

void Painter::grasp(const Grasp& grasp, const Gripper& gripper, const Transform& T_view_camera, Rgb8 color, bool bold) {
  const Transform T_view_tcp = T_view_camera * grasp.T_camera_tcp;
  const double half = 0.5 * grasp.width_m, back = -gripper.finger_length_m, thickness = bold ? 4 : 1.2, alpha = bold ? 1.0 : 0.6;
  const auto stroke = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    line(T_view_tcp * from, T_view_tcp * to, color, thickness, alpha);
  };
  stroke({0, half, 0}, {back, half, 0});
  stroke({0, -half, 0}, {back, -half, 0});
  stroke({back, half, 0}, {back, -half, 0});
  stroke({back, 0, 0}, {back - 0.6 * gripper.palm_depth_m, 0, 0});
  if (!bold) return;
  for (const GraspContact& contact : grasp.contacts) dot(T_view_camera * contact.point, 4, contact.observed ? color : kWhite);
}

}  // namespace gfp
