#pragma once

#include <vector>

#include "primitive/family_shape.hpp"
#include "primitive/surface_builder.hpp"

namespace gfp {

/// One section of a loft: p = centre + e.x u + e.y v with e on a superellipse; u x v points where the loft travels.
struct LoftSection {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), u = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
  double squareness = 2;
  Part part = Part::kBody;
  double sag_m = 0;  ///< p.z += sag e.x^2: a spoon's bowl.
};

/// A closed skin over the sections with a pole at either end (at the first and last centre, moved by `bulge_m` along the travel).
std::vector<Ring> add_loft(SurfaceBuilder& builder, const std::vector<LoftSection>& sections, int columns, const std::vector<Window>& windows = {}, double bulge_m = 0);

/// A section across the x axis: half width along y, from z_low to z_high.
LoftSection section_x(double x, double half_width, double z_low, double z_high, double squareness, Part part = Part::kBody);


}  // namespace gfp
