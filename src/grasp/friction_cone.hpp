#pragma once

#include <Eigen/Core>
#include <array>

#include "gfp/grasp/wrench_space.hpp"

namespace gfp {

/// A contact's wrenches as a linear map of its own coordinates (normal force, tangential 1, tangential 2, torsion), the
/// last three in units of their friction limit: the admissible set is a cone over a fixed polygon or bipyramid.
struct ContactMap {
  Eigen::Matrix<double, 6, 4> wrench_of_local;
  bool soft = false;  ///< False: the torsion column is zero.
};
ContactMap contact_map(const WrenchContact& contact, const WrenchScale& scale);

/// The sides of the friction polygon over E edges: normal - a[j] tangential1 - b[j] tangential2 -+ torsion >= 0.
struct PolygonSides {
  static constexpr int kMax = 64;
  std::array<double, kMax> a, b;
};
PolygonSides polygon_sides(int cone_edges);

}  // namespace gfp
