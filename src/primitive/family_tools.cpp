// Tools and cutlery as they lie (or, the drill, stand) on a table: screwdriver, knife, spoon, hammer, drill, clamp.
#include <numbers>

#include "primitive/curves.hpp"
#include "primitive/loft.hpp"

namespace gfp {
namespace {

/// A tool along x: middle of its extent over the origin, lowest point on z = 0, reference size its extent.
FamilyShape laid_down(const SurfaceBuilder& builder) {
  FamilyShape shape = builder.finish(Eigen::Vector3d::Ones());
  const Bounds box = bounds(shape.mesh.vertices);
  const Eigen::Vector3d offset(box.centre().x(), 0, box.low.z());
  for (auto& p : shape.mesh.vertices) p -= offset;
  shape.reference_size_m = box.size();
  return shape;
}

}  // namespace

FamilyShape make_screwdriver(ParameterDraw& draw) {
  const double length = draw.log_range(0.12, 0.32), handle = length * draw.range(0.36, 0.54), radius = length * draw.range(0.05, 0.085);
  const double shaft = radius * draw.range(0.16, 0.34), waist = draw.range(0.62, 0.9), end = draw.range(0.7, 1.0), neck = draw.range(0.45, 0.8);
  const double squareness = draw.range(2.0, 3.0), tip = draw.range(0.3, 0.9);
  const Spline girth({0, 0.06, 0.3, 0.7, 0.9, 1}, {0.7 * end, end, 1.0, waist, neck + 0.1, neck});
  std::vector<LoftSection> sections;
  const auto round = [&](double x, double r, double n, Part part) { sections.push_back(section_x(x, r, -r, r, n, part)); };
  constexpr int kHandle = 20, kShaft = 12;
  for (int i = 0; i < kHandle; ++i) round(handle * i / (kHandle - 1), radius * girth(i / (kHandle - 1.0)), squareness, Part::kHandle);
  round(handle, 1.15 * shaft, 2, Part::kNeck);
  for (int i = 1; i < kShaft; ++i) round(mix(handle, 0.93 * length, i / (kShaft - 1.0)), shaft, 2, Part::kBody);
  sections.push_back(section_x(length, 1.05 * shaft, -tip * shaft, tip * shaft, 2.6));
  SurfaceBuilder builder;
  add_loft(builder, sections, 12, {}, 0.001);
  return laid_down(builder);
}

FamilyShape make_knife(ParameterDraw& draw) {
  const double length = draw.log_range(0.16, 0.34), handle = length * draw.range(0.34, 0.5), half_width = length * draw.range(0.032, 0.05);
  const double thickness = length * draw.range(0.03, 0.06), blade = thickness * draw.range(0.12, 0.3), blade_width = half_width * draw.range(0.75, 1.3);
  const double taper = draw.range(0.35, 0.95), belly = draw.range(0.7, 0.95), squareness = draw.range(2.2, 3.2);
  const Spline wide({0, 0.5, 0.85, 1}, {belly, 1.0, mix(taper, 1.0, 0.4), 0.3 * taper});
  constexpr int kHandle = 14, kBlade = 20;
  std::vector<LoftSection> sections;
  const Spline grip({0, 0.1, 0.5, 1}, {0.7, 1.0, belly, 1.0});
  for (int i = 0; i < kHandle; ++i) {
    const double u = i / (kHandle - 1.0);
    sections.push_back(section_x(handle * u, half_width * grip(u), -0.5 * thickness, 0.5 * thickness, squareness, Part::kHandle));
  }
  for (int i = 0; i < kBlade; ++i) {
    const double u = i / (kBlade - 1.0);
    sections.push_back(section_x(mix(handle + 0.03 * length, length, u), blade_width * wide(u), -0.5 * blade, 0.5 * blade, 2.4));
  }
  SurfaceBuilder builder;
  add_loft(builder, sections, 12, {}, 0.0005);
  return laid_down(builder);
}

FamilyShape make_spoon(ParameterDraw& draw) {
  const double length = draw.log_range(0.12, 0.3), bowl = length * draw.range(0.26, 0.36), width = bowl * draw.range(0.55, 0.8);
  const double stem = length * draw.range(0.014, 0.024), end = stem * draw.range(1.2, 2.6), thickness = length * draw.log_range(0.011, 0.02);
  const double depth = width * draw.range(0.1, 0.24), lift = length * draw.range(0.02, 0.09), pointed = draw.range(-0.15, 0.15);
  const double neck = length - bowl;
  constexpr int kStem = 20, kBowl = 18;
  std::vector<LoftSection> sections;
  const auto flat = [&](double x, double half_width, double z, double sag, Part part) {
    auto section = section_x(x, half_width, z - 0.5 * thickness, z + 0.5 * thickness, 2.4, part);
    section.sag_m = sag;
    sections.push_back(section);
  };
  // The stem rises from the bowl's rim to its highest place and comes down to its end.
  const Spline rise({0, 0.5, 1}, {draw.range(0.3, 0.9) * lift + depth, 0.6 * lift + depth, depth});
  for (int i = 0; i < kStem; ++i) {
    const double u = i / (kStem - 1.0);
    flat(neck * u, mix(i == 0 ? 0.8 * end : end, stem, smooth_step(0, 0.7, u)), rise(u), 0, Part::kHandle);
  }
  for (int i = 1; i <= kBowl; ++i) {
    const double u = i / (kBowl + 0.6), round = std::sqrt(std::max(0.0, 1 - std::pow(2 * u - 1, 2)));
    const double low = depth * (1 - std::pow(round, 1.6));
    flat(neck + bowl * u, std::max(0.5 * width * round * (1 + pointed * (2 * u - 1)), stem), low, depth - low, Part::kBody);
  }
  SurfaceBuilder builder;
  add_loft(builder, sections, 12, {}, 0.0005);
  return laid_down(builder);
}

/// Lies flat: the shaft along x, the head across it along y at the +x end.
FamilyShape make_hammer(ParameterDraw& draw) {
  const double length = draw.log_range(0.2, 0.4), head = length * draw.range(0.3, 0.44), face = head * draw.range(0.1, 0.15);
  const double cheek = face * draw.range(0.8, 1.05), peen_high = face * draw.range(0.25, 0.9), peen_wide = face * draw.range(0.5, 1.1), droop = head * draw.range(0.0, 0.12);
  const double grip_wide = length * draw.range(0.034, 0.052), grip_high = std::min(grip_wide * draw.range(0.7, 1.0), 0.98 * face), swell = draw.range(0.55, 0.85);
  const double split = draw.range(0.36, 0.5);  // where along the head the shaft sits
  std::vector<LoftSection> sections;
  const auto across = [&](double share, double high, double wide, double n, double bend) {
    sections.push_back({{-bend, head * share, 0}, {0, 0, high}, {wide, 0, 0}, n, Part::kBody, 0});
  };
  for (const double s : {0.0, 0.03, 0.1, 0.17}) across(s, face * (s == 0.0 ? 0.9 : 1.0), face * (s == 0.0 ? 0.9 : 1.0), 2.2, 0);
  across(0.22, 0.75 * cheek, 0.75 * cheek, 2.2, 0);
  const double half = 0.085;
  for (const double s : {split - 0.09, split - half, split, split + half, split + 0.09})
    across(s, cheek * (std::abs(s - split) > half ? 0.9 : 1.0), cheek, 3, 0);
  for (int i = 1; i <= 6; ++i) {
    const double u = i / 6.0;
    across(mix(split + 0.12, 1.0, u), mix(0.85 * cheek, peen_high, u), mix(0.85 * cheek, peen_wide, u), 2.6, droop * u * u);
  }
  constexpr int kColumns = 16;
  const Window window{6, 8, 3 * kColumns / 4, 2};
  SurfaceBuilder builder;
  const auto rings = add_loft(builder, sections, kColumns, {window}, 0.001);
  std::vector<TubeSection> shaft;
  const Spline girth({0, 0.2, 0.55, 0.8, 1}, {0.8, swell, 0.9, 1.0, 0.95});
  constexpr int kShaft = 22;
  const double begin = cheek + 0.02 * length;
  for (int i = 0; i <= kShaft; ++i) {
    const double u = static_cast<double>(i) / kShaft, s = girth(u) * (i == kShaft ? 0.7 : 1.0);
    shaft.push_back({{-mix(begin, length - cheek, u), head * split, 0}, {0, -1, 0}, {0, 0, 1}, s * grip_wide * 0.6, s * grip_high * 0.75, 2.4});
  }
  builder.stub(SurfaceBuilder::window_loop(rings, window), shaft, shaft.back().centre - Eigen::Vector3d(0.003, 0, 0), Part::kHandle);
  FamilyShape hammer = laid_down(builder);
  for (auto& p : hammer.mesh.vertices) p.y() -= head * split;  // the shaft over the x axis
  return hammer;
}

/// Stands on its battery: barrel along +x on top, grip below.
FamilyShape make_drill(ParameterDraw& draw) {
  const double length = draw.log_range(0.15, 0.25), height = length * draw.range(0.85, 1.2), radius = length * draw.range(0.14, 0.19);
  const double chuck = radius * draw.range(0.5, 0.75), nose = draw.range(0.62, 0.76), back = draw.range(0.75, 1.0), tip = draw.range(0.3, 0.7);
  const double grip_long = length * draw.range(0.085, 0.12), grip_wide = radius * draw.range(0.5, 0.68), lean = length * draw.range(-0.02, 0.1);
  const double battery_long = length * draw.range(0.2, 0.3), battery_wide = radius * draw.range(0.8, 1.15), battery_high = height * draw.range(0.16, 0.3);
  const double axis = height - radius, squareness = draw.range(2.0, 2.8);
  std::vector<LoftSection> sections;
  const auto round = [&](double share, double r, double n, Part part = Part::kBody) { sections.push_back(section_x(length * share, r, axis - r, axis + r, n, part)); };
  for (const auto& [s, r] : {std::pair{0.0, 0.8 * back}, {0.03, back}, {0.11, 0.5 * (1 + back)}}) round(s, radius * r, squareness);
  const double grip_share = 0.3, half = grip_long / length;
  for (const double s : {grip_share - half, grip_share, grip_share + half}) round(s, radius, squareness);
  for (int i = 1; i <= 4; ++i) round(mix(grip_share + half, nose, i / 4.0), radius * mix(1.0, 0.86, i / 4.0), squareness);
  for (const auto& [s, r] : {std::pair{0.02, 1.0}, {0.1, 1.0}, {0.18, 0.9}}) round(nose + s, chuck * r, 2, Part::kNeck);
  round(1.0, chuck * tip, 2, Part::kNeck);
  constexpr int kColumns = 16;
  const Window window{3, 5, 3 * kColumns / 4, 2};
  SurfaceBuilder builder;
  const auto rings = add_loft(builder, sections, kColumns, {window}, 0.002);

  std::vector<TubeSection> grip;
  const auto level = [&](double z, double half_long, double half_wide, double n, double ahead) {
    grip.push_back({{length * grip_share + ahead, 0, z}, {-1, 0, 0}, {0, 1, 0}, half_long, half_wide, n});
  };
  const double top = axis - 1.12 * radius;
  constexpr int kGrip = 8;
  for (int i = 0; i < kGrip; ++i) {
    const double u = i / (kGrip - 1.0);
    level(mix(top, 1.12 * battery_high, u), grip_long * mix(1.0, 0.88, u), grip_wide, 2.4, -lean * u);
  }
  for (const double z : {1.0, 0.66, 0.33, 0.04, 0.0})
    level(battery_high * z, battery_long * (z == 0.0 ? 0.95 : 1.0), battery_wide * (z == 0.0 ? 0.92 : 1.0), 4, 0.25 * battery_long - lean);
  builder.stub(SurfaceBuilder::window_loop(rings, window), grip, grip.back().centre, Part::kHandle);
  return laid_down(builder);
}

/// A G-clamp, lying flat: the frame a C open towards +x in the horizontal plane, the screw through its +y arm.
FamilyShape make_clamp(ParameterDraw& draw) {
  const double opening = draw.log_range(0.04, 0.14), throat = opening * draw.range(0.55, 0.95), bar = opening * draw.range(0.09, 0.15), high = bar * draw.range(0.7, 1.15);
  const double screw = bar * draw.range(0.45, 0.62), reach = draw.range(0.2, 0.6), out = opening * draw.range(0.35, 0.8), knob = screw * draw.range(1.4, 2.4);
  const double corner = draw.range(2.6, 5.0), squareness = draw.range(2.2, 3.2), h = 0.5 * opening + bar;
  const double pad = draw.range(1.1, 1.6);
  // The frame's centre line: from the fixed jaw back, up the spine, and out again.
  std::vector<Eigen::Vector2d> line;
  constexpr int kSteps = 120;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (0.5 + static_cast<double>(i) / kSteps);  // half a superellipse, run clockwise seen from +z
    const Eigen::Vector2d p = superellipse({i % kSteps == 0 ? 0.0 : std::cos(angle), -std::sin(angle)}, corner);
    line.emplace_back(throat * p.x(), h * p.y());
  }
  const auto points = resample(line, 22);
  std::vector<LoftSection> sections;
  const auto frame = [&](const Eigen::Vector2d& at, const Eigen::Vector2d& travel, double scale) {
    sections.push_back({{at.x(), at.y(), 0}, scale * bar * Eigen::Vector3d(-travel.y(), travel.x(), 0), {0, 0, scale * high}, squareness, Part::kBody, 0});
  };
  frame({1.3 * bar, -h}, {-1, 0}, 0.8 * pad);
  frame({0.9 * bar, -h}, {-1, 0}, pad);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) frame(points[i], (points[i + 1] - points[i - 1]).normalized(), 1);
  const std::size_t boss = sections.size();
  const double middle = 0.9 * bar, half = 0.75 * bar;
  for (const double x : {middle - half, middle, middle + half}) frame({x, h}, {1, 0}, 1.1);
  frame({middle + 1.05 * bar, h}, {1, 0}, 0.85);
  constexpr int kColumns = 12;
  const Window outer{boss, boss + 2, 0, 1}, inner{boss, boss + 2, kColumns / 2, 1};
  SurfaceBuilder builder;
  const auto rings = add_loft(builder, sections, kColumns, {outer, inner}, 0.001);
  const auto rod = [&](const Window& window, double side, const std::vector<std::pair<double, double>>& profile) {
    std::vector<TubeSection> tube;
    for (const auto& [along, radius] : profile) tube.push_back({{middle, h + side * (1.1 * bar + along), 0}, {-1, 0, 0}, {0, 0, side}, radius, radius, 2});
    builder.stub(SurfaceBuilder::window_loop(rings, window), tube, tube.back().centre + Eigen::Vector3d(0, side * 0.001, 0), Part::kHandle);
  };
  rod(outer, 1, {{0.12 * out, screw}, {0.4 * out, screw}, {0.7 * out, screw}, {0.78 * out, knob}, {0.97 * out, knob}, {out, 0.8 * knob}});
  const double in = reach * opening;
  rod(inner, -1, {{0.15 * in, screw}, {0.45 * in, screw}, {0.75 * in, screw}, {0.82 * in, knob}, {0.97 * in, knob}, {in, 0.8 * knob}});
  return laid_down(builder);
}

}  // namespace gfp
