#pragma once

#include <optional>
#include <vector>

#include "primitive/curves.hpp"
#include "primitive/family_shape.hpp"
#include "primitive/surface_builder.hpp"

namespace gfp {

/// A closed loop in the plane y = 0 that grows from the wall at +x: from `low` up to `high`.
struct LoopHandle {
  double low_m = 0, high_m = 0;        ///< Heights of its two roots.
  double reach_m = 0;                  ///< Farthest from the wall, to the tube's axis.
  double half_thickness_m = 0;         ///< Across the strap, in the plane y = 0.
  double half_width_m = 0;             ///< Along y.
  double squareness = 2;               ///< 2: round (C); 3: square (D).
  double skew = 0;                     ///< > 0: bulges above (ear).
  int sections = 10;
  int rows_between = 1;                ///< Rows of the wall between the two roots.
};

/// A straight bar in the plane y = 0 that grows from the wall at +x: a pan's handle.
struct BarHandle {
  double root_m = 0;                   ///< Height of its root.
  double length_m = 0;
  double rise_m = 0;                   ///< Of its end over its root.
  double half_thickness_m = 0;         ///< Vertical.
  double half_width_m = 0;             ///< Along y, at the end; narrower at the root.
};

/// A pouring lip at -x: wall and rim are drawn outwards near the rim.
struct Lip {
  double reach_m = 0;
  double half_angle_rad = 0.7;
  double begin = 0.7;  ///< Share of the height where it starts.
};

/// A shell of revolution, open above: outer wall, rim, inner wall at `thickness_m` inside it, floor.
struct Vessel {
  double height_m = 0;
  Spline radius_m{{0, 1}, {1, 1}};     ///< Of the outer wall over the share of the height.
  double thickness_m = 0.004;          ///< Horizontal.
  double floor_m = 0.006;
  double base_edge_m = 0.003;          ///< Rounding of the base's edge.
  int columns = 24;
  int outer_rows = 11, inner_rows = 7;
  std::optional<LoopHandle> handle;    ///< At most one of the two.
  std::optional<BarHandle> bar;
  std::optional<Lip> lip;
};

FamilyShape build_vessel(const Vessel& vessel);

/// Rings of a disc from its middle to just inside its edge, as strides and shares of the radius (columns divisible by 4).
struct DiscRing {
  int stride;
  double share;
};
inline constexpr DiscRing kDisc[] = {{0, 0.0}, {4, 0.26}, {2, 0.51}, {1, 0.77}};

/// One ring of a body of revolution.
struct ProfileRing {
  double radius_m = 0, height_m = 0;
  RingSpec spec;
};

/// Appends the rings of a disc at one height, from the middle outwards or from the edge inwards; the edge itself is the caller's.
void append_disc(std::vector<ProfileRing>& profile, double radius_m, double height_m, Part part, bool inwards, double dome_m = 0);

/// Sweeps a profile around z with round sections (divide x and y apart for oval ones).
FamilyShape build_lathe(const std::vector<ProfileRing>& profile, int columns, std::size_t rim, const Eigen::Vector3d& reference_size_m);

inline constexpr std::size_t kNoRim = std::numeric_limits<std::size_t>::max();

}  // namespace gfp
