#include "simulation/settle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/footprint.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kContact_m = 1e-7;  ///< Vertices this near to the table touch it.
constexpr double kBalanced_m = 1e-6; ///< The centre of mass may overhang by this much.

double lowest(const std::vector<Vector3d>& points) {
  double z = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points) z = std::min(z, p.z());
  return z;
}

/// How far the body turns about a level axis through `pivot` until its next vertex touches down; `towards` (unit) is where it falls.
double angle_to_next_contact(const std::vector<Vector3d>& points, double table_z, const Vector2d& pivot, const Vector2d& towards) {
  double angle = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points) {
    const double height = p.z() - table_z;
    if (height < kContact_m) continue;  // touches already, and lies behind the pivot
    angle = std::min(angle, std::atan2(height, towards.dot(p.head<2>() - pivot)));
  }
  return angle;
}

}  // namespace

Matrix3d settle(const std::vector<Vector3d>& vertices_body, const Vector3d& centre_of_mass_body, Matrix3d R_world_body) {
  constexpr int kMaxTips = 1000;
  std::vector<Vector3d> points(vertices_body.size());  // about the centre of mass, which is so the origin
  for (int tip = 0; tip < kMaxTips; ++tip) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = R_world_body * (vertices_body[i] - centre_of_mass_body);
    const double table_z = lowest(points);
    std::vector<Vector2d> contacts;
    for (const Vector3d& p : points)
      if (p.z() < table_z + kContact_m) contacts.emplace_back(p.head<2>());
    const Vector2d pivot = nearest_point(convex_hull(std::move(contacts)), Vector2d::Zero());
    const double overhang = pivot.norm();
    if (overhang < kBalanced_m) break;
    const Vector2d towards = -pivot / overhang;
    const double angle = angle_to_next_contact(points, table_z, pivot, towards);
    if (!std::isfinite(angle)) break;  // a flat body: all of it touches
    const Vector3d axis(-towards.y(), towards.x(), 0);  // turns `towards` down
    R_world_body = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * R_world_body;
  }
  return R_world_body;
}

}  // namespace gfp
