// Open dishes: bowl, plate, pan.
#include "primitive/vessel.hpp"

namespace gfp {

FamilyShape make_bowl(ParameterDraw& draw) {
  const double width = draw.log_range(0.09, 0.42), radius = 0.5 * width;
  const double height = width * draw.log_range(0.24, 0.62);
  const double foot = radius * draw.range(0.32, 0.68), foot_height = height * draw.log_range(0.015, 0.14);
  const double fullness = draw.range(0.34, 0.95);  // exponent of radius over height: a third is a hemisphere, one a cone
  const double flare = draw.range(-0.06, 0.1);
  const double t = width * draw.log_range(0.014, 0.036), floor = t * draw.range(1.0, 1.6);

  const double grown = radius * (1 - std::max(flare, 0.0));
  // Outside at share u of the height above the foot; inside is the same curve t narrower and `floor` higher.
  const auto outer = [&](double u) { return foot + (grown - foot) * std::pow(u, fullness) + radius * std::max(flare, 0.0) * std::pow(u, 5.0) + radius * std::min(flare, 0.0) * std::pow(u, 8.0); };

  std::vector<ProfileRing> profile;
  append_disc(profile, foot, 0, Part::kBase, false, 0.4 * foot_height);
  profile.push_back({foot, 0, {Part::kBase}});
  constexpr int kRows = 10;
  for (int i = 0; i < kRows; ++i) {
    const double u = std::pow((i + 0.25) / (kRows - 0.75), 1.6);
    profile.push_back({outer(u), mix(foot_height, height - 0.5 * t, u), {i + 1 == kRows ? Part::kRim : Part::kBody}});
  }
  const std::size_t rim = profile.size();
  profile.push_back({outer(1) - 0.5 * t, height, {Part::kRim}});
  for (int i = kRows - 1; i >= 1; --i) {
    const double u = std::pow((i + 0.25) / (kRows - 0.75), 1.6);
    profile.push_back({outer(u) - t, mix(foot_height + floor, height - 0.5 * t, u), {i + 1 == kRows ? Part::kRim : Part::kInnerWall}});
  }
  const double u0 = std::pow(0.25 / (kRows - 0.75), 1.6);
  profile.push_back({outer(u0) - t, mix(foot_height + floor, height, u0), {Part::kInnerWall}});
  append_disc(profile, outer(u0) - t, foot_height + floor, Part::kInnerWall, true);
  double widest = 0;
  for (const auto& ring : profile) widest = std::max(widest, 2 * ring.radius_m);
  return build_lathe(profile, 24, rim, {widest, widest, height});
}

FamilyShape make_plate(ParameterDraw& draw) {
  const double width = draw.log_range(0.14, 0.32), radius = 0.5 * width, height = width * draw.log_range(0.065, 0.17);
  const double t = std::min(0.45 * height, width * draw.log_range(0.012, 0.026));
  const double well = draw.range(0.45, 0.72);            // share of the radius that lies flat
  const double a = draw.range(0.2, 0.5), b = draw.range(0.5, 0.86);  // share of the rise after one and two thirds of the slope
  const Spline rise({0, 1.0 / 3, 2.0 / 3, 1}, {0, a, b, 1});
  const auto under = [&](double share) { return (height - t) * rise((share - well) / (1 - well)); };

  std::vector<ProfileRing> profile;
  append_disc(profile, radius * well, 0, Part::kBase, false);
  constexpr int kRows = 7;
  for (int i = 0; i < kRows; ++i) {
    const double share = mix(well, 1.0, i / (kRows - 1.0));
    profile.push_back({radius * share, under(share), {i == 0 ? Part::kBase : i + 1 == kRows ? Part::kRim : Part::kBody}});
  }
  profile.push_back({radius, under(1) + 0.55 * t, {Part::kRim}});
  const std::size_t rim = profile.size();
  profile.push_back({radius * 0.985, height, {Part::kRim}});
  for (int i = kRows - 2; i >= 0; --i) {
    const double share = mix(well, 1.0, i / (kRows - 1.0));
    profile.push_back({radius * share, under(share) + t, {Part::kInnerWall}});
  }
  append_disc(profile, radius * well, t, Part::kInnerWall, true);
  return build_lathe(profile, 24, rim, {width, width, height});
}

FamilyShape make_pan(ParameterDraw& draw) {
  const double width = draw.log_range(0.14, 0.32);
  Vessel pan;
  pan.height_m = width * draw.log_range(0.16, 0.5);
  const double radius = 0.5 * width, base = draw.range(0.72, 0.98);
  pan.radius_m = Spline({0, 0.5, 1}, {radius * base, radius * mix(base, 1.0, draw.range(0.45, 0.85)), radius});
  pan.thickness_m = width * draw.log_range(0.012, 0.024);
  pan.floor_m = pan.thickness_m * draw.range(1.0, 1.8);
  pan.base_edge_m = std::min(pan.height_m * draw.range(0.05, 0.12), pan.floor_m + 1.2 * pan.thickness_m);  // the wall stays outside the floor
  pan.outer_rows = 7;
  pan.inner_rows = 4;
  pan.columns = 24;
  BarHandle bar;
  bar.half_thickness_m = std::min(0.11 * pan.height_m, width * draw.range(0.02, 0.034));
  bar.root_m = pan.height_m * draw.range(0.55, 0.76);
  bar.length_m = width * draw.range(0.55, 1.0);
  bar.rise_m = bar.length_m * draw.range(-0.02, 0.3);
  bar.half_width_m = width * draw.range(0.04, 0.07);
  pan.bar = bar;
  return build_vessel(pan);
}

}  // namespace gfp
