#include "grasp/close_jaw.hpp"

#include <algorithm>
#include <vector>

#include "grasp/gripper_boxes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A convex polygon of at most 3 + 6 corners (a triangle cut by six planes).
struct Polygon {
  std::array<Vector3d, 12> corners;
  std::size_t size = 0;
};

/// Keeps the part where sign * p[axis] <= bound (Sutherland & Hodgman).
void cut(Polygon& polygon, int axis, double sign, double bound) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector3d &p = polygon.corners[i], &q = polygon.corners[i + 1 < polygon.size ? i + 1 : 0];
    const double hp = sign * p[axis] - bound, hq = sign * q[axis] - bound;
    if (hp <= 0) kept.corners[kept.size++] = p;
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) kept.corners[kept.size++] = p + hp / (hp - hq) * (q - p);
  }
  polygon = kept;
}

struct Piece {
  Polygon polygon;
  Vector3d normal;  // outward, unit
  std::int32_t triangle;
};

/// Parts of the mesh inside the gap, tcp frame.
std::vector<Piece> pieces_in(const Bounds& gap, const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles, const Transform& T_tcp_world) {
  std::vector<Piece> pieces;
  for (const std::int32_t t : triangles) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    Piece piece{{}, {}, t};
    auto& p = piece.polygon.corners;
    p[0] = T_tcp_world * mesh.vertices[static_cast<std::size_t>(a)];
    p[1] = T_tcp_world * mesh.vertices[static_cast<std::size_t>(b)];
    p[2] = T_tcp_world * mesh.vertices[static_cast<std::size_t>(c)];
    piece.polygon.size = 3;
    const Vector3d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    if ((low.array() > gap.high.array()).any() || (high.array() < gap.low.array()).any()) continue;
    piece.normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double length = piece.normal.norm();
    if (length == 0) continue;
    piece.normal /= length;
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] > gap.high[axis]) cut(piece.polygon, axis, 1, gap.high[axis]);
      if (low[axis] < gap.low[axis]) cut(piece.polygon, axis, -1, -gap.low[axis]);
    }
    if (piece.polygon.size > 0) pieces.push_back(piece);
  }
  return pieces;
}

/// The touch of the pad that comes from side * y.
PadTouch touch(const std::vector<Piece>& pieces, double side) {
  double first = -1e300;
  Vector3d first_point = Vector3d::Zero();
  std::int32_t first_triangle = -1;
  for (const Piece& piece : pieces)
    for (std::size_t i = 0; i < piece.polygon.size; ++i)
      if (side * piece.polygon.corners[i].y() > first) {
        first = side * piece.polygon.corners[i].y();
        first_point = piece.polygon.corners[i];
        first_triangle = piece.triangle;
      }
  double area = 0, largest = 0;
  Vector3d moment = Vector3d::Zero(), normal = Vector3d::Zero();
  for (const Piece& piece : pieces) {
    if (side * piece.normal.y() <= 0) continue;  // seen from behind: inside the object
    Polygon patch = piece.polygon;
    cut(patch, 1, -side, kPadGive - first);
    double patch_area = 0;
    for (std::size_t i = 1; i + 1 < patch.size; ++i) {
      const double part = 0.5 * (patch.corners[i] - patch.corners[0]).cross(patch.corners[i + 1] - patch.corners[0]).norm();
      moment += part / 3.0 * (patch.corners[0] + patch.corners[i] + patch.corners[i + 1]);
      patch_area += part;
    }
    area += patch_area;
    normal += patch_area * piece.normal;
    if (patch_area > largest) { largest = patch_area; first_triangle = piece.triangle; }
  }
  if (area < 1e-10) return {first_point, -side * Vector3d::UnitY(), first_triangle};  // 0.01 mm x 0.01 mm: an edge
  return {moment / area, -normal.normalized(), first_triangle};
}

}  // namespace

std::optional<std::array<PadTouch, 2>> close_jaw(const TriangleMesh& mesh_world, const TriangleBvh& bvh, const Gripper& gripper,
                                                 const Transform& T_world_tcp, double opening_m) {
  const Bounds gap = gap_tcp(gripper, opening_m);
  std::vector<std::int32_t> near;
  bvh.gather(OrientedBox::of(gap, T_world_tcp), near);
  const std::vector<Piece> pieces = pieces_in(gap, mesh_world, near, T_world_tcp.inverse());
  if (pieces.empty()) return std::nullopt;
  return std::array{touch(pieces, 1), touch(pieces, -1)};
}

}  // namespace gfp
