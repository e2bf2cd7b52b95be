#include "grasp/close_jaw.hpp"

#include <algorithm>
#include <vector>

#include "grasp/gripper_boxes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A convex polygon: a triangle cut by at most seven planes.
struct Polygon {
  std::array<Vector3d, 12> corners;
  std::size_t size = 0;
};

/// Keeps the part where sign * p[axis] <= bound (Sutherland & Hodgman).
void cut(Polygon& polygon, int axis, double sign, double bound) {
  const Polygon whole = polygon;
  polygon.size = 0;
  for (std::size_t i = 0; i < whole.size; ++i) {
    const Vector3d &p = whole.corners[i], &q = whole.corners[i + 1 < whole.size ? i + 1 : 0];
    const double hp = sign * p[axis] - bound, hq = sign * q[axis] - bound;
    if (hp <= 0) polygon.corners[polygon.size++] = p;
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) polygon.corners[polygon.size++] = p + hp / (hp - hq) * (q - p);
  }
}

/// What one pad can meet: parts of triangles inside the gap that face it, tcp frame. `side` is +1 or -1: where it comes from.
class Pad {
 public:
  explicit Pad(double side) : side_(side) {}

  void meet(const Polygon& polygon, const Vector3d& normal, std::int32_t triangle) {
    double reach = -1e300;
    for (std::size_t i = 0; i < polygon.size; ++i) reach = std::max(reach, side_ * polygon.corners[i].y());
    if (reach <= first_ - kPadGive) return;  // what came before keeps the pad away from it
    pieces_.push_back({polygon, normal, reach, triangle});
    first_ = std::max(first_, reach);
  }

  bool touches() const { return !pieces_.empty(); }

  PadTouch touch() {
    double force = 0, largest = 0;
    PadTouch touch;
    for (Piece& piece : pieces_) {
      if (piece.reach <= first_ - kPadGive) continue;
      cut(piece.polygon, 1, -side_, kPadGive - first_);
      const double share = press(piece.polygon, touch.point);
      force += share;
      touch.normal -= share * piece.normal;
      if (share > largest || touch.triangle < 0) { largest = share; touch.triangle = piece.triangle; }
    }
    if (force < 1e-13) return bare_touch();  // a patch of 0.01 mm x 0.01 mm pressed in by 1 mm
    touch.point /= force;
    touch.normal.normalize();
    return touch;
  }

 private:
  struct Piece {
    Polygon polygon;
    Vector3d normal;  // outward, unit
    double reach;
    std::int32_t triangle;
  };

  /// Integral of depth over the patch, and of depth times place added to `moment`: exact, depth being linear.
  double press(const Polygon& patch, Vector3d& moment) const {
    double force = 0;
    for (std::size_t i = 1; i + 1 < patch.size; ++i) {
      const Vector3d &a = patch.corners[0], &b = patch.corners[i], &c = patch.corners[i + 1];
      const double area = 0.5 * (b - a).cross(c - a).norm();
      const double da = depth(a), db = depth(b), dc = depth(c), sum = da + db + dc;
      force += area / 3 * sum;
      moment += area / 12 * ((sum + da) * a + (sum + db) * b + (sum + dc) * c);
    }
    return force;
  }
  double depth(const Vector3d& p) const { return std::max(0.0, side_ * p.y() - first_ + kPadGive); }

  PadTouch bare_touch() const {
    const auto piece = std::max_element(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.reach < b.reach; });
    const auto& corners = piece->polygon.corners;
    const auto corner = std::max_element(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(piece->polygon.size),
                                         [&](const Vector3d& a, const Vector3d& b) { return side_ * a.y() < side_ * b.y(); });
    return {*corner, -side_ * Vector3d::UnitY(), piece->triangle};
  }

  double side_, first_ = -1e300;
  std::vector<Piece> pieces_;
};

}  // namespace

std::optional<std::array<PadTouch, 2>> close_jaw(const TriangleMesh& mesh_world, const TriangleBvh& bvh, const Gripper& gripper,
                                                 const Transform& T_world_tcp, double opening_m) {
  const Bounds gap = gap_tcp(gripper, opening_m);
  const Transform T_tcp_world = T_world_tcp.inverse();
  std::vector<std::int32_t> near;
  bvh.gather(OrientedBox::of(gap, T_world_tcp), near);
  Pad plus(1), minus(-1);
  for (const std::int32_t t : near) {
    const auto& [a, b, c] = mesh_world.triangles[static_cast<std::size_t>(t)];
    Polygon polygon;
    auto& p = polygon.corners;
    p[0] = T_tcp_world * mesh_world.vertices[static_cast<std::size_t>(a)];
    p[1] = T_tcp_world * mesh_world.vertices[static_cast<std::size_t>(b)];
    p[2] = T_tcp_world * mesh_world.vertices[static_cast<std::size_t>(c)];
    polygon.size = 3;
    const Vector3d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    if ((low.array() > gap.high.array()).any() || (high.array() < gap.low.array()).any()) continue;
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    if (normal.y() == 0) continue;  // neither pad can press on it
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] > gap.high[axis]) cut(polygon, axis, 1, gap.high[axis]);
      if (low[axis] < gap.low[axis]) cut(polygon, axis, -1, -gap.low[axis]);
    }
    if (polygon.size > 0) (normal.y() > 0 ? plus : minus).meet(polygon, normal, t);
  }
  if (!plus.touches() || !minus.touches()) return std::nullopt;
  return std::array{plus.touch(), minus.touch()};
}

}  // namespace gfp
