#include "grasp/friction_cone.hpp"

#include <cmath>
#include <numbers>

#include "gfp/core/transform.hpp"

namespace gfp {

ContactMap contact_map(const WrenchContact& contact, const WrenchScale& scale) {
  const auto [t1, t2] = orthonormal_basis(contact.normal);
  const Eigen::Vector3d arm = (contact.point - scale.centre) / scale.radius_m;
  ContactMap map;
  map.soft = contact.torsion_m > 0;
  auto& m = map.wrench_of_local;
  m.col(0) << contact.normal, arm.cross(contact.normal);
  m.col(1) << contact.friction * t1, contact.friction * arm.cross(t1);
  m.col(2) << contact.friction * t2, contact.friction * arm.cross(t2);
  m.col(3) << Eigen::Vector3d::Zero(), contact.friction * contact.torsion_m / scale.radius_m * contact.normal;
  return map;
}

PolygonSides polygon_sides(int cone_edges) {
  PolygonSides sides;
  const double half = std::numbers::pi / cone_edges;
  const double c = std::cos(2 * half), s = std::sin(2 * half);
  double a = 1, b = std::tan(half);  // the first side's normal over its apothem, then turned from side to side
  for (std::size_t j = 0; j < static_cast<std::size_t>(cone_edges); ++j) {
    sides.a[j] = a;
    sides.b[j] = b;
    const double turned = c * a - s * b;
    b = s * a + c * b;
    a = turned;
  }
  return sides;
}

}  // namespace gfp
