// Hollow vessels of revolution: mug, jug, cup, vase, wine glass. Ranges are what shops sell, not one object's measures.
#include "primitive/vessel.hpp"

namespace gfp {
namespace {

/// Radii at five equal heights: a cone (taper < 0 narrows upwards), a belly in the middle (< 0: a waist), and some freedom.
std::vector<double> wall_radii(ParameterDraw& draw, double radius, double taper, double belly, double freedom) {
  std::vector<double> radii;
  for (int i = 0; i < 5; ++i) {
    const double u = 0.25 * i;
    radii.push_back(radius * (1 + taper * (u - 0.5) + belly * 4 * u * (1 - u) + freedom * draw.range(-1, 1)));
  }
  return radii;
}

const std::vector<double> kFifths{0, 0.25, 0.5, 0.75, 1};

}  // namespace

FamilyShape make_mug(ParameterDraw& draw) {
  const double width = draw.log_range(0.058, 0.108);
  Vessel mug;
  mug.height_m = width * draw.log_range(0.75, 1.5);
  const double taper = draw.range(-0.12, 0.26), belly = draw.range(-0.09, 0.12);
  mug.radius_m = Spline(kFifths, wall_radii(draw, 0.48 * width, taper, belly, 0.015));
  mug.thickness_m = width * draw.log_range(0.028, 0.06);
  mug.floor_m = mug.thickness_m * draw.range(1.0, 1.8);
  mug.base_edge_m = width * draw.range(0.02, 0.07);
  LoopHandle handle;
  handle.low_m = mug.height_m * draw.range(0.2, 0.34);
  handle.high_m = mug.height_m * draw.range(0.7, 0.84);
  handle.reach_m = width * draw.range(0.22, 0.46);
  handle.half_thickness_m = width * draw.range(0.03, 0.06);
  handle.half_width_m = width * draw.range(0.05, 0.1);
  handle.squareness = draw.range(1.8, 3.0);
  handle.skew = draw.range(-0.1, 0.3);
  mug.handle = handle;
  return build_vessel(mug);
}

FamilyShape make_jug(ParameterDraw& draw) {
  const double width = draw.log_range(0.09, 0.2);
  Vessel jug;
  jug.height_m = width * draw.log_range(1.05, 1.95);
  const double base = draw.range(0.62, 1.0), belly = draw.range(0.9, 1.1), shoulder = draw.range(0.72, 1.0), neck = draw.range(0.55, 0.85);
  jug.radius_m = Spline({0, 0.32, 0.66, 0.85, 1}, {0.5 * width * base, 0.5 * width * belly, 0.5 * width * shoulder, 0.5 * width * neck,
                                                   0.5 * width * (neck + draw.range(-0.03, 0.14))});
  jug.thickness_m = width * draw.log_range(0.026, 0.045);
  jug.floor_m = jug.thickness_m * draw.range(1.0, 1.8);
  jug.base_edge_m = width * draw.range(0.015, 0.05);
  jug.outer_rows = 13;
  jug.inner_rows = 11;
  LoopHandle handle;
  handle.low_m = jug.height_m * draw.range(0.28, 0.4);
  handle.high_m = jug.height_m * draw.range(0.72, 0.86);
  handle.reach_m = width * draw.range(0.3, 0.5);
  handle.half_thickness_m = width * draw.range(0.025, 0.05);
  handle.half_width_m = width * draw.range(0.04, 0.08);
  handle.squareness = draw.range(1.9, 2.8);
  handle.skew = draw.range(-0.05, 0.3);
  handle.sections = 11;
  handle.rows_between = 3;
  jug.handle = handle;
  jug.lip = Lip{width * draw.range(0.05, 0.2), draw.range(0.55, 0.9), draw.range(0.6, 0.8)};
  return build_vessel(jug);
}

FamilyShape make_cup(ParameterDraw& draw) {
  const double width = draw.log_range(0.06, 0.105);
  Vessel cup;
  cup.height_m = width * draw.log_range(0.75, 2.0);
  const double taper = draw.range(-0.1, 0.55), belly = draw.range(-0.07, 0.1);
  cup.radius_m = Spline(kFifths, wall_radii(draw, 0.43 * width, taper, belly, 0.012));
  cup.thickness_m = width * draw.log_range(0.015, 0.045);
  cup.floor_m = width * draw.log_range(0.025, 0.11);
  cup.base_edge_m = width * draw.range(0.015, 0.05);
  return build_vessel(cup);
}

FamilyShape make_vase(ParameterDraw& draw) {
  const double width = draw.log_range(0.08, 0.26);
  Vessel vase;
  vase.height_m = width * draw.log_range(1.1, 2.6);
  const double r = 0.5 * width;
  const double base = draw.range(0.45, 0.85), low = draw.range(0.75, 1.0), high = draw.range(0.65, 1.05), neck = draw.range(0.32, 0.8);
  vase.radius_m = Spline({0, 0.25, 0.55, 0.82, 1}, {r * base, r * low, r * high, r * neck, r * (neck + draw.range(0.0, 0.3))});
  vase.thickness_m = width * draw.log_range(0.02, 0.045);
  vase.floor_m = vase.thickness_m * draw.range(1.0, 2.0);
  vase.base_edge_m = width * draw.range(0.015, 0.04);
  vase.outer_rows = 14;
  vase.inner_rows = 12;
  return build_vessel(vase);
}

FamilyShape make_wine_glass(ParameterDraw& draw) {
  const double width = draw.log_range(0.06, 0.105), height = width * draw.log_range(1.7, 2.9);
  const double stem_share = draw.range(0.3, 0.52), stem = width * draw.range(0.045, 0.075), foot = 0.5 * width * draw.range(0.75, 1.0);
  const double t = width * draw.log_range(0.018, 0.03), bowl = height * (1 - stem_share), bottom = height * stem_share;
  const double belly = 0.5 * width * draw.range(0.9, 1.0), mouth = belly * draw.range(0.68, 1.0), hip = belly * draw.range(0.72, 0.92);
  const Spline radius({0, 0.15, 0.45, 1}, {1.1 * stem, hip * 0.8, belly, mouth});

  std::vector<ProfileRing> profile;
  append_disc(profile, foot, 0, Part::kBase, false);
  const double foot_height = 0.03 * height * draw.range(0.8, 1.3);
  profile.push_back({foot, 0, {Part::kBase}});
  profile.push_back({foot, 0.02 * width, {Part::kBase}});
  profile.push_back({0.55 * foot, 0.02 * width + 0.4 * foot_height, {Part::kBase}});
  profile.push_back({1.3 * stem, 0.02 * width + foot_height, {Part::kNeck}});
  constexpr int kStemRows = 5;
  for (int i = 1; i <= kStemRows; ++i) profile.push_back({stem, mix(0.02 * width + foot_height, bottom, i / (kStemRows + 1.0)), {Part::kNeck}});
  constexpr int kBowlRows = 9;
  for (int i = 0; i < kBowlRows; ++i) {
    const double u = std::pow(i / (kBowlRows - 1.0), 1.4);
    profile.push_back({radius(u), bottom + u * (bowl - 0.5 * t), {i + 1 == kBowlRows ? Part::kRim : Part::kBody}});
  }
  const std::size_t rim = profile.size();
  profile.push_back({mouth - 0.5 * t, height, {Part::kRim}});
  // The same curve, narrower and starting higher: inside the outer one wherever that widens; above, walls are near upright.
  constexpr int kInnerRows = 7;
  const double floor = bottom + 0.13 * bowl;
  for (int i = 0; i < kInnerRows; ++i) {
    const double z = mix(height - 0.5 * t, floor + 0.04 * bowl, std::pow(i / (kInnerRows - 1.0), 0.9));
    profile.push_back({radius((z - bottom) / bowl) - t * (1 + 1.2 * smooth_step(0.5, 0.0, (z - bottom) / bowl)), z, {i == 0 ? Part::kRim : Part::kInnerWall}});
  }
  append_disc(profile, 0.75 * profile.back().radius_m, floor, Part::kInnerWall, true);
  return build_lathe(profile, 24, rim, {2 * belly, 2 * belly, height});
}

}  // namespace gfp
