#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// What a family's function builds: object frame (z up, base at z = 0), metres.
struct FamilyShape {
  TriangleMesh mesh;
  std::vector<bool> filled;          ///< Per triangle: also part of the surface with the cavity closed.
  std::vector<std::int32_t> lid;     ///< Rim loop that closes it, counter-clockwise from outside; empty for solid bodies.
  std::vector<Part> parts;           ///< Per vertex.
  Eigen::Vector3d reference_size_m;  ///< What the canonical frame divides by.
};

/// Draws a family's parameters. `spread` 0 gives every range's centre; 1 its whole; at most 1.25 is taken.
class ParameterDraw {
 public:
  ParameterDraw(Random& random, double spread) : random_(random), spread_(std::clamp(spread, 0.0, 1.25)) {}

  double range(double low, double high) { return 0.5 * (low + high) + 0.5 * (high - low) * spread_ * random_.uniform(-1, 1); }
  /// Even in the logarithm: for lengths and ratios that span more than a factor of 1.5.
  double log_range(double low, double high) { return std::exp(range(std::log(low), std::log(high))); }

 private:
  Random& random_;
  double spread_;
};

/// One parametric class.
struct FamilySpec {
  std::string_view name;
  std::string_view class_name = name;
  FamilyShape (*make)(ParameterDraw& draw);
  std::vector<std::string> aliases = {};
  Symmetry symmetry;
  int genus = 0;
  bool hollow = false;
  double upright_share = 0.75;  ///< Of such objects on tables stand (or lie) in the canonical pose.
};

/// All families, sorted by name.
const std::vector<FamilySpec>& family_specs();
const FamilySpec* find_family(std::string_view name);

/// Splits every triangle into four, `levels` times; new vertices follow the curved surface (PN triangles' edge midpoints).
void refine(FamilyShape& shape, int levels);

/// Bends space around the object by a smooth, one-to-one map: nothing that was free of intersections gets one, the base stays
/// on z = 0. `amplitude` is the largest displacement as a share of the object's largest extent, at most 0.08.
void bend_freely(FamilyShape& shape, double amplitude, Random& random);

/// The outside with its lid: a closed surface on the same vertices.
std::vector<Triangle> filled_triangles(const FamilyShape& shape);

FamilyShape make_mug(ParameterDraw& draw);
FamilyShape make_jug(ParameterDraw& draw);
FamilyShape make_cup(ParameterDraw& draw);
FamilyShape make_vase(ParameterDraw& draw);
FamilyShape make_wine_glass(ParameterDraw& draw);
FamilyShape make_bowl(ParameterDraw& draw);
FamilyShape make_plate(ParameterDraw& draw);
FamilyShape make_can(ParameterDraw& draw);
FamilyShape make_bottle(ParameterDraw& draw);
FamilyShape make_flat_bottle(ParameterDraw& draw);
FamilyShape make_jar(ParameterDraw& draw);
FamilyShape make_box(ParameterDraw& draw);
FamilyShape make_pan(ParameterDraw& draw);
FamilyShape make_ball(ParameterDraw& draw);
FamilyShape make_banana(ParameterDraw& draw);
FamilyShape make_screwdriver(ParameterDraw& draw);
FamilyShape make_knife(ParameterDraw& draw);
FamilyShape make_spoon(ParameterDraw& draw);
FamilyShape make_hammer(ParameterDraw& draw);
FamilyShape make_drill(ParameterDraw& draw);
FamilyShape make_clamp(ParameterDraw& draw);
FamilyShape make_shoe(ParameterDraw& draw);
FamilyShape make_slipper(ParameterDraw& draw);
FamilyShape make_carton(ParameterDraw& draw);
FamilyShape make_spray_bottle(ParameterDraw& draw);
FamilyShape make_toy_car(ParameterDraw& draw);

}  // namespace gfp
