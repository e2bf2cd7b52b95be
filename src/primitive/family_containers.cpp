// Closed containers of revolution: can, bottle, jar. Their surface is solid: a camera never looks into them.
#include "primitive/vessel.hpp"

namespace gfp {
namespace {

constexpr int kColumns = 24;

/// Rows between two rings, ends excluded, straight up.
void append_rows(std::vector<ProfileRing>& profile, int count, double low_m, double high_m, Part part, const Spline& radius) {
  for (int i = 1; i <= count; ++i) {
    const double z = mix(low_m, high_m, static_cast<double>(i) / (count + 1));
    profile.push_back({radius(z), z, {part}});
  }
}

/// A short upright cylinder (cap, lid, neck ring) with a rounded upper edge.
void append_band(std::vector<ProfileRing>& profile, double radius_m, double low_m, double high_m, double edge_m, Part part) {
  profile.push_back({radius_m, low_m, {part}});
  profile.push_back({radius_m, 0.5 * (low_m + high_m), {part}});
  profile.push_back({radius_m, high_m - edge_m, {part}});
  profile.push_back({radius_m - edge_m, high_m, {part}});
}

}  // namespace

FamilyShape make_can(ParameterDraw& draw) {
  const double width = draw.log_range(0.048, 0.17), radius = 0.5 * width;
  // Tuna tins are wide, crisps tubes tall; tall ones are never wide: the ratio narrows with the width.
  const double height = width * draw.log_range(0.36, 2.9) * std::pow(width / 0.09, -0.35);
  const double low_edge = radius * draw.range(0.02, 0.14), high_edge = radius * draw.range(0.02, 0.14);
  const double low_inset = radius * draw.range(0.02, 0.13), high_inset = radius * draw.range(0.02, 0.13);
  const double recess = std::min(0.06 * height, radius * draw.range(0.01, 0.12));
  const double belly = draw.range(-0.03, 0.03), taper = draw.range(-0.03, 0.03);
  const Spline wall({0, 0.5 * height, height}, {radius * (1 - 0.5 * taper), radius * (1 + belly), radius * (1 + 0.5 * taper)});

  std::vector<ProfileRing> profile;
  append_disc(profile, wall(0) - low_inset, 0.5 * recess, Part::kBase, false);
  profile.push_back({wall(0) - low_inset, 0, {Part::kBase}});
  profile.push_back({wall(0), low_edge, {Part::kBody}});
  append_rows(profile, 9, low_edge, height - high_edge, Part::kBody, wall);
  profile.push_back({wall(height), height - high_edge, {Part::kBody}});
  profile.push_back({wall(height) - high_inset, height, {Part::kRim}});
  const double lid = wall(height) - high_inset - 0.05 * radius;
  profile.push_back({lid, height - recess, {Part::kCap}});
  append_disc(profile, lid, height - recess, Part::kCap, true);
  return build_lathe(profile, kColumns, kNoRim, {width, width, height});
}

namespace {

/// `flatness`: depth over width; `squareness`: of the body's section. Neck and cap are round.
FamilyShape build_bottle(ParameterDraw& draw, double flatness, double squareness) {
  const double width = draw.log_range(0.038, 0.105), radius = 0.5 * width;
  const double height = width * draw.log_range(1.7, 4.3);
  const double neck = radius * draw.log_range(0.26, 0.72) * (0.45 + 0.55 * flatness);
  const double shoulder = draw.range(0.46, 0.76), slope = draw.range(0.08, 0.24);
  const double neck_begin = std::min(shoulder + slope, 0.9), cap_height = height * mix(0.35, 1.0, draw.range(0, 1)) * (1 - neck_begin) * 0.62;
  const double cap = std::min(neck * draw.range(1.04, 1.4), 0.97 * radius * flatness), cap_begin = height - cap_height;
  const double base = draw.range(0.86, 1.0), waist = draw.range(0.86, 1.02), swell = draw.range(0.9, 1.0), heel = 0.12 * radius;
  const double s = shoulder * height, n = neck_begin * height;

  // Shares of the body's radius up to the shoulder; above it the section shrinks to the neck and becomes round.
  const Spline body({0, 0.12 * s, 0.5 * s, 0.85 * s, s}, {base, 0.5 * (base + 1), waist, 1.0, swell});
  const double bulge = draw.range(-0.6, 0.6);  // shoulder: hollow cone (wine) to dome (milk)
  const auto narrowing = [&](double z) {
    const double u = std::clamp((z - s) / (n - s), 0.0, 1.0), straight = smooth_step(-0.15, 1.0, u) ;
    return mix(straight, u * u, std::max(bulge, 0.0)) * (1 - std::max(-bulge, 0.0)) + std::sqrt(u) * std::max(-bulge, 0.0);
  };

  struct Row {
    double z, scale, roundness;  ///< scale: radius over x; roundness: 0 the body's section, 1 a circle of `scale`
    RingSpec spec;
  };
  std::vector<Row> rows;
  const double foot = radius * base - heel;
  for (const auto& [stride, share] : kDisc) rows.push_back({0, foot * share, 0, {Part::kBase, stride}});
  rows.push_back({0, foot, 0, {Part::kBase}});
  const auto body_row = [&](double z) {
    const double u = narrowing(z);
    rows.push_back({z, mix(radius * body(z), neck, u), smooth_step(0, 1, u), {z > n - 1e-12 ? Part::kNeck : Part::kBody}});
  };
  constexpr int kBodyRows = 10, kShoulderRows = 5;
  for (int i = 0; i <= kBodyRows; ++i) body_row(mix(heel, s, static_cast<double>(i) / kBodyRows));
  for (int i = 1; i <= kShoulderRows; ++i) body_row(mix(s, n, static_cast<double>(i) / kShoulderRows));
  for (int i = 1; i <= 2; ++i) rows.push_back({mix(n, cap_begin, i / 3.0), neck, 1, {Part::kNeck}});
  rows.push_back({cap_begin, neck, 1, {Part::kNeck}});
  const double lip = 0.04 * cap_height, edge = 0.12 * std::min(cap_height, cap);
  for (const auto& [z, r] : {std::pair{cap_begin + lip, cap}, {mix(cap_begin, height, 0.5), cap}, {height - edge, cap}, {height, cap - edge}})
    rows.push_back({z, r, 1, {Part::kCap}});
  rows.push_back({height, 0.5 * (cap - edge), 1, {Part::kCap, 2}});
  rows.push_back({height, 0, 1, {Part::kCap, 0}});

  const auto circle = unit_circle(kColumns);
  std::vector<RingSpec> specs;
  for (const auto& row : rows) specs.push_back(row.spec);
  SurfaceBuilder builder;
  builder.sweep(specs, kColumns, [&](std::size_t r, int column) {
    const auto& direction = circle[static_cast<std::size_t>(column)];
    const Row& row = rows[r];
    const Eigen::Vector2d section = superellipse(direction, squareness).cwiseProduct(Eigen::Vector2d(1, flatness));
    const Eigen::Vector2d p = row.scale * (section * (1 - row.roundness) + direction * row.roundness);
    return Eigen::Vector3d(p.x(), p.y(), row.z);
  });
  return builder.finish({width, width * flatness, height});
}

}  // namespace

FamilyShape make_bottle(ParameterDraw& draw) { return build_bottle(draw, 1.0, 2.0); }

FamilyShape make_flat_bottle(ParameterDraw& draw) {
  const double flatness = draw.range(0.45, 1.0), squareness = draw.range(2.0, 3.6);
  return build_bottle(draw, flatness, squareness);
}

FamilyShape make_jar(ParameterDraw& draw) {
  const double width = draw.log_range(0.048, 0.13), radius = 0.5 * width, height = width * draw.log_range(0.75, 1.9);
  const double neck = radius * draw.range(0.62, 0.92), lid = std::min(neck * draw.range(1.02, 1.12), radius);
  const double lid_height = std::min(0.24 * height, width * draw.range(0.12, 0.26)), shoulder = draw.range(0.06, 0.2) * height;
  const double lid_begin = height - lid_height, s = lid_begin - shoulder - 0.03 * height;
  const double heel = radius * draw.range(0.04, 0.2);
  const Spline wall({0, 0.5 * s, s}, {radius * draw.range(0.85, 1), radius * draw.range(0.9, 1), radius});
  const double dome = draw.range(0.0, 1.0);

  std::vector<ProfileRing> profile;
  append_disc(profile, wall(0) - heel, 0, Part::kBase, false);
  profile.push_back({wall(0) - heel, 0, {Part::kBase}});
  profile.push_back({wall(heel), heel, {Part::kBody}});
  append_rows(profile, 6, heel, s, Part::kBody, wall);
  profile.push_back({wall(s), s, {Part::kBody}});
  for (int i = 1; i <= 3; ++i) {
    const double u = i / 3.0;
    profile.push_back({mix(radius, neck, mix(u, u * u, dome)), mix(s, lid_begin - 0.03 * height, mix(u, std::sqrt(u), 0.3 * dome)), {i == 3 ? Part::kNeck : Part::kBody}});
  }
  profile.push_back({neck, lid_begin, {Part::kNeck}});
  append_band(profile, lid, lid_begin + 0.05 * lid_height, height, 0.12 * lid_height, Part::kCap);
  append_disc(profile, lid - 0.12 * lid_height, height, Part::kCap, true);
  return build_lathe(profile, kColumns, kNoRim, {width, width, height});
}

}  // namespace gfp
