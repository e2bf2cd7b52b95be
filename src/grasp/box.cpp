#include "grasp/box.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfp {
namespace {

using Eigen::Vector3d;

double squared_outside(const Vector3d& p, const Vector3d& half) { return (p.cwiseAbs() - half).cwiseMax(0.0).squaredNorm(); }

/// Least squared distance of the segment p + t d, 0 <= t <= 1, to the box: convex and quadratic between the parameters where
/// the segment crosses the box's six planes.
double segment_squared_distance(const Vector3d& p, const Vector3d& d, const Vector3d& half) {
  std::array<double, 8> breaks;
  std::size_t count = 0;
  breaks[count++] = 0;
  for (int i = 0; i < 3; ++i)
    for (const double side : {-half[i], half[i]}) {
      const double t = (side - p[i]) / d[i];  // infinite or NaN where parallel: refused by the comparison
      if (!(t > 0 && t < 1)) continue;
      std::size_t place = count++;
      for (; breaks[place - 1] > t; --place) breaks[place] = breaks[place - 1];  // breaks[0] = 0 ends it
      breaks[place] = t;
    }
  breaks[count++] = 1;
  double least = std::min(squared_outside(p, half), squared_outside(p + d, half));
  for (std::size_t k = 0; k + 1 < count; ++k) {
    // Inside this interval each axis is below, within or above the box throughout: the parabola's vertex, clamped.
    const Vector3d middle = p + 0.5 * (breaks[k] + breaks[k + 1]) * d;
    double curvature = 0, slope = 0;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(middle[i]) <= half[i]) continue;
      curvature += d[i] * d[i];
      slope += d[i] * (p[i] - std::copysign(half[i], middle[i]));
    }
    const double t = curvature > 0 ? std::clamp(-slope / curvature, breaks[k], breaks[k + 1]) : breaks[k];
    least = std::min(least, squared_outside(p + t * d, half));
  }
  return least;
}

/// Squared distance of a point to the triangle's inside only: infinite where its foot lies outside (edges are done apart).
double face_squared_distance(const Vector3d& p, const Vector3d& a, const Vector3d& ab, const Vector3d& ac, const Vector3d& normal) {
  const double squared = normal.squaredNorm();
  const Vector3d ap = p - a;
  const double v = ap.cross(ac).dot(normal), w = ab.cross(ap).dot(normal);
  if (!(squared > 0) || v < 0 || w < 0 || v + w > squared) return 1e300;
  const double height = ap.dot(normal);
  return height * height / squared;
}

}  // namespace

bool triangle_meets_box(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& half) {
  const Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  if ((low.array() > half.array()).any() || (high.array() < -half.array()).any()) return false;
  const Vector3d ab = b - a, bc = c - b, ca = a - c;
  const Vector3d normal = ab.cross(bc);
  if (std::abs(normal.dot(a)) > normal.cwiseAbs().dot(half)) return false;
  const auto separates = [&](const Vector3d& axis) {
    const double pa = axis.dot(a), pb = axis.dot(b), pc = axis.dot(c), reach = axis.cwiseAbs().dot(half);
    return std::min({pa, pb, pc}) > reach || std::max({pa, pb, pc}) < -reach;
  };
  for (const Vector3d& e : {ab, bc, ca}) {
    if (separates({0, -e.z(), e.y()}) || separates({e.z(), 0, -e.x()}) || separates({-e.y(), e.x(), 0})) return false;
  }
  return true;
}

double triangle_box_distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& half) {
  if (triangle_meets_box(a, b, c, half)) return 0;
  double least = std::min({segment_squared_distance(a, b - a, half), segment_squared_distance(b, c - b, half), segment_squared_distance(c, a - c, half)});
  const Vector3d ab = b - a, ac = c - a, normal = ab.cross(ac);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p((corner & 1) != 0 ? half.x() : -half.x(), (corner & 2) != 0 ? half.y() : -half.y(), (corner & 4) != 0 ? half.z() : -half.z());
    least = std::min(least, face_squared_distance(p, a, ab, ac, normal));
  }
  return std::sqrt(least);
}

double bounds_box_distance(const Vector3d& centre, const Vector3d& extent, const OrientedBox& box) {
  const Vector3d reach = box.T_box_world.linear().cwiseAbs() * extent + box.half;
  return ((box.T_box_world * centre).cwiseAbs() - reach).cwiseMax(0.0).norm();
}

double point_box_distance(const Vector3d& point_world, const OrientedBox& box) {
  return std::sqrt(squared_outside(box.T_box_world * point_world, box.half));
}

}  // namespace gfp
