// Household things that are no bodies of revolution: shoe, carton, spray bottle, toy car.
#include <numbers>

#include "primitive/curves.hpp"
#include "primitive/loft.hpp"
#include "primitive/vessel.hpp"

namespace gfp {
namespace {

/// Closed outline in a plane: x from heel to toe around the centre, y symmetric, wider at the ball than at the heel.
struct Outline {
  double centre_x, half_length, half_width, widening, squareness, z_front, z_back;

  Eigen::Vector3d at(const Eigen::Vector2d& direction) const {
    const Eigen::Vector2d e = superellipse(direction, squareness);
    return {centre_x + half_length * e.x(), half_width * e.y() * (1 + widening * e.x()), mix(z_back, z_front, 0.5 + 0.5 * e.x())};
  }
};

}  // namespace

/// A shoe with an opening for the foot, toe towards +x: slipper, low shoe, boot. The cavity ends over the insole.
FamilyShape make_shoe(ParameterDraw& draw) {
  const double length = draw.log_range(0.19, 0.32), half = 0.5 * length, half_width = length * draw.range(0.16, 0.2), sole = length * draw.range(0.05, 0.12);
  const double ankle = length * draw.range(0.18, 0.36), shaft = length * draw.log_range(0.02, 0.6);
  const double opening = length * draw.range(0.2, 0.35), thickness = length * draw.range(0.014, 0.026), vamp = draw.range(0.25, 0.75), widening = draw.range(0.08, 0.2);
  const double lean = length * draw.range(-0.02, 0.04), slope = length * draw.range(-0.02, 0.06);
  const Outline foot{0, half, half_width, widening, draw.range(2.1, 2.7), sole, sole};
  const Outline collar{-half + opening + 0.02 * length, opening, half_width * draw.range(0.62, 0.8), 0.02, 2.1, ankle + slope, ankle};
  Outline rim = collar;
  rim.centre_x -= lean;
  rim.z_front += shaft;
  rim.z_back += shaft;

  constexpr int kUpperRows = 9, kShaftRows = 4, kInnerRows = 6, kColumns = 28;
  const auto circle = unit_circle(kColumns);
  std::vector<RingSpec> specs;
  std::vector<std::function<Eigen::Vector3d(const Eigen::Vector2d&)>> rings;
  const auto add = [&](const RingSpec& spec, std::function<Eigen::Vector3d(const Eigen::Vector2d&)> ring) {
    specs.push_back(spec);
    rings.push_back(std::move(ring));
  };
  const auto flat = [&](double share, double z) {
    return [=](const Eigen::Vector2d& d) {
      const Eigen::Vector3d p = foot.at(d);
      return Eigen::Vector3d(share * p.x(), share * p.y(), z);
    };
  };
  for (const auto& [stride, share] : kDisc) add({Part::kBase, stride}, flat(0.95 * share, 0));
  add({Part::kBase}, flat(0.95, 0));
  add({Part::kBase}, flat(1.0, 0.3 * sole));
  for (int i = 0; i <= kUpperRows; ++i) {
    const double t = static_cast<double>(i) / kUpperRows;
    add({Part::kBody}, [=](const Eigen::Vector2d& d) {
      const Eigen::Vector3d from = foot.at(d), to = collar.at(d);
      const double front = 0.5 + 0.5 * d.x(), inwards = 1 - std::cos(0.5 * std::numbers::pi * t);
      const double upwards = mix(std::sin(0.5 * std::numbers::pi * t), t, vamp * front * front);
      return Eigen::Vector3d(mix(from.x(), to.x(), mix(inwards, t, 0.35)), mix(from.y(), to.y(), inwards), mix(from.z(), to.z(), upwards));
    });
  }
  const auto upright = [&](const Outline& low, const Outline& high, double t, double inset) {
    return [=](const Eigen::Vector2d& d) -> Eigen::Vector3d {
      const Eigen::Vector3d p = mix(0, 1, 1 - t) * low.at(d) + t * high.at(d);
      const double cx = mix(low.centre_x, high.centre_x, t), k = 1 - inset / low.half_width, kx = 1 - inset / low.half_length;
      return {cx + kx * (p.x() - cx), k * p.y(), p.z()};
    };
  };
  for (int i = 1; i <= kShaftRows; ++i) add({i == kShaftRows ? Part::kRim : Part::kBody}, upright(collar, rim, static_cast<double>(i) / kShaftRows, 0));
  Outline top = rim;
  top.z_front += 0.4 * thickness;
  top.z_back += 0.4 * thickness;
  const std::size_t edge = rings.size();
  add({Part::kRim}, upright(collar, top, 1, 0.5 * thickness));
  for (int i = 0; i < kShaftRows; ++i) add({i == 0 ? Part::kRim : Part::kInnerWall}, upright(collar, rim, 1 - static_cast<double>(i) / kShaftRows, thickness));
  Outline insole = collar;
  insole.z_front = insole.z_back = sole + 0.12 * (ankle - sole);
  insole.half_width *= 0.97;
  for (int i = 0; i <= kInnerRows; ++i) add({Part::kInnerWall}, upright(insole, collar, 1 - static_cast<double>(i) / kInnerRows, 1.2 * thickness));
  for (std::size_t i = std::size(kDisc); i-- > 0;) {
    const double share = kDisc[i].share * 0.97;
    add({Part::kInnerWall, kDisc[i].stride}, [=](const Eigen::Vector2d& d) -> Eigen::Vector3d {
      const Eigen::Vector3d p = insole.at(d);
      return {insole.centre_x + share * (1 - 1.2 * thickness / insole.half_length) * (p.x() - insole.centre_x), share * (1 - 1.2 * thickness / insole.half_width) * p.y(), p.z()};
    });
  }
  SurfaceBuilder builder;
  builder.sweep(specs, kColumns, [&](std::size_t r, int column) { return rings[r](circle[static_cast<std::size_t>(column)]); }, {{}, edge});
  return builder.finish({length, 2 * half_width * (1 + 0.5 * widening), std::max(top.z_front, top.z_back)});
}

/// A slide: a sole, toe towards +x, and a broad strap from side to side over it. One sees through below the strap: genus 1.
FamilyShape make_slipper(ParameterDraw& draw) {
  const double length = draw.log_range(0.2, 0.31), ball = length * draw.range(0.15, 0.2), heel = ball * draw.range(0.66, 0.9), waist = draw.range(0.78, 0.98);
  const double sole = length * draw.range(0.05, 0.13), toe_sole = sole * draw.range(0.6, 1.05);
  const double middle = draw.range(0.6, 0.74), strap = draw.range(0.24, 0.42), height = sole + length * draw.range(0.12, 0.26);
  const double thickness = length * draw.range(0.014, 0.034), flare = draw.range(-0.15, 0.2), blunt = draw.range(4, 9);
  const Spline width({0, 0.2, 0.45, 0.72, 1}, {heel, heel, waist * 0.5 * (heel + ball), ball, 0.9 * ball});

  // The strap grows from rings kFirst to kLast of the sole, wherever the strap is.
  constexpr int kSections = 20, kFirst = 9, kLast = 15, kColumns = 24;
  const double from = middle - 0.5 * strap, to = std::min(middle + 0.5 * strap, 0.93);
  std::vector<LoftSection> sections;
  for (int i = 0; i <= kSections; ++i) {
    const double u = i <= kFirst  ? mix(0.0, from, std::pow(static_cast<double>(i) / kFirst, 1.2))
                     : i <= kLast ? mix(from, to, static_cast<double>(i - kFirst) / (kLast - kFirst))
                                  : mix(to, 1.0, 1 - std::pow(1 - static_cast<double>(i - kLast) / (kSections - kLast), 1.3));
    const double rounding = std::pow(1 - std::pow(std::abs(0.985 * (2 * u - 1)), blunt), 0.5);
    sections.push_back(section_x((u - 0.5) * length, width(u) * rounding, 0, mix(sole, toe_sole, u), 4.5));
  }
  constexpr int kSide = 2;  // the column beside the top edge
  const Window left{kFirst, kLast, kSide, 1}, right{kFirst, kLast, kColumns / 2 - kSide, 1};
  SurfaceBuilder builder;
  const auto rings = add_loft(builder, sections, kColumns, {left, right}, 0.002);
  const double x = (0.5 * (from + to) - 0.5) * length, low = 0.8 * mix(sole, toe_sole, middle), reach = width(middle) + 0.6 * thickness;
  constexpr int kArc = 13;
  std::vector<TubeSection> arc;
  for (int i = 0; i < kArc; ++i) {
    const double angle = mix(0.12, std::numbers::pi - 0.12, i / (kArc - 1.0)), rise = height - 0.5 * thickness - low;
    const Eigen::Vector3d travel = Eigen::Vector3d(0, -reach * std::sin(angle), rise * std::cos(angle)).normalized(), outward(-1, 0, 0);
    const double half = 0.5 * (to - from) * length * (1 + flare * std::sin(angle)) * 0.96;
    arc.push_back({{x, reach * std::cos(angle), low + rise * std::sin(angle)}, outward, travel.cross(outward), half, 0.5 * thickness, 5});
  }
  Ring end = SurfaceBuilder::window_loop(rings, right, true);
  std::rotate(end.begin(), end.begin() + static_cast<std::ptrdiff_t>(end.size() / 2), end.end());  // from its heel end, like the strap's sections
  builder.tube(SurfaceBuilder::window_loop(rings, left), arc, end, Part::kBody);
  return builder.finish({length, 2 * ball, height});
}

/// A gable-top carton: a square column, a roof that folds to a ridge along y, an upright fin.
FamilyShape make_carton(ParameterDraw& draw) {
  const double width = draw.log_range(0.055, 0.105), depth = width * draw.range(0.85, 1.15), height = width * draw.log_range(1.5, 3.2);
  const double fin = width * draw.range(0.1, 0.22), roof = width * draw.range(0.3, 0.55), edge = width * draw.range(0.015, 0.05);
  const double half_fin = width * draw.range(0.012, 0.03), swell = draw.range(-0.01, 0.04), fold = draw.range(0.9, 1.0);
  const double wall = height - fin - roof, a = 0.5 * width, b = 0.5 * depth;
  struct Level {
    double z, half_x, half_y;
    RingSpec spec;
  };
  std::vector<Level> levels;
  constexpr int kColumns = 24, kWall = 10, kRoof = 5;
  for (const auto& [stride, share] : kDisc) levels.push_back({0, share * (a - edge), share * (b - edge), {Part::kBase, stride}});
  levels.push_back({0, a - edge, b - edge, {Part::kBase}});
  for (int i = 0; i <= kWall; ++i) {
    const double u = static_cast<double>(i) / kWall, bow = 1 + swell * 4 * u * (1 - u);
    levels.push_back({mix(edge, wall, u), a * bow, b * bow, {Part::kBody}});
  }
  for (int i = 1; i <= kRoof; ++i) {
    const double u = static_cast<double>(i) / kRoof;
    levels.push_back({mix(wall, wall + roof, u), mix(a, half_fin, u), b * mix(1, fold, u), {Part::kCap}});
  }
  for (const double u : {0.5, 1.0}) levels.push_back({wall + roof + u * fin, half_fin, b * fold, {Part::kCap}});
  levels.push_back({height, 0, 0, {Part::kCap, 0}});
  std::vector<RingSpec> specs;
  for (const auto& level : levels) specs.push_back(level.spec);
  // Evenly spaced around a square with hardly rounded corners.
  const auto circle = unit_circle(kColumns);
  const auto square = [&](int column) {
    const Eigen::Vector2d& d = circle[static_cast<std::size_t>(column)];
    const double x = std::abs(d.x()), y = std::abs(d.y()), eighth = std::atan2(std::min(x, y), std::max(x, y)) / (0.25 * std::numbers::pi);
    const double longer = eighth > 0.99 ? 0.97 : 1.0, shorter = longer * eighth;
    return Eigen::Vector2d(std::copysign(x >= y ? longer : shorter, d.x()), std::copysign(x >= y ? shorter : longer, d.y()));
  };
  SurfaceBuilder builder;
  builder.sweep(specs, kColumns, [&](std::size_t r, int column) -> Eigen::Vector3d {
    const Eigen::Vector2d s = square(column);
    return {levels[r].half_x * s.x(), levels[r].half_y * s.y(), levels[r].z};
  });
  return builder.finish({width, depth, height});
}

/// A bottle with a trigger head that points to +x.
FamilyShape make_spray_bottle(ParameterDraw& draw) {
  const double width = draw.log_range(0.07, 0.12), height = width * draw.range(2.1, 3.1), flat = draw.range(0.55, 1.0), squareness = draw.range(2.0, 3.0);
  const double a = 0.5 * width, b = a * flat, shoulder = height * draw.range(0.5, 0.6), waist = draw.range(0.8, 1.0);
  const double neck = std::min(0.36 * a, 0.6 * b) * draw.range(0.85, 1.1), neck_low = height * draw.range(0.68, 0.72), head_low = height * 0.83;
  const double nose = a * draw.range(1.0, 1.6), back = a * draw.range(0.35, 0.7), head_wide = neck * draw.range(0.9, 1.15), trigger = height * draw.range(0.09, 0.13);
  const Spline body({0, 0.5, 1}, {0.97, waist, 1.0});
  struct Level {
    double z, x0, x1, half_y, n;
    RingSpec spec;
  };
  std::vector<Level> levels;
  const auto push = [&](double z, double x0, double x1, double half_y, double n, RingSpec spec) { levels.push_back({z, x0, x1, half_y, n, spec}); };
  constexpr int kColumns = 20, kBody = 9;
  for (const auto& [stride, share] : kDisc) push(0, -0.9 * a * share, 0.9 * a * share, 0.9 * b * share, squareness, {Part::kBase, stride});
  push(0, -0.9 * a, 0.9 * a, 0.9 * b, squareness, {Part::kBase});
  for (int i = 0; i <= kBody; ++i) {
    const double u = static_cast<double>(i) / kBody, s = body(u);
    push(mix(0.05 * a, shoulder, u), -a * s, a * s, b * mix(1, s, 0.5), squareness, {Part::kBody});
  }
  for (int i = 1; i <= 4; ++i) {
    const double u = i / 4.0, s = smooth_step(-0.2, 1.0, u);
    push(mix(shoulder, neck_low, u), -mix(a, neck, s), mix(a, neck, s), mix(b, neck, s), mix(squareness, 2, u), {i == 4 ? Part::kNeck : Part::kBody});
  }
  for (int i = 1; i <= 4; ++i) push(mix(neck_low, head_low, i / 4.0), -neck, neck, neck, 2, {Part::kNeck});
  const std::size_t window_row = levels.size() - 3;
  for (const double u : {0.08, 0.4, 0.75, 0.94}) push(mix(head_low, height, u), -back * mix(1, 0.85, u), nose * mix(1, 0.9, u), head_wide, 3, {Part::kCap});
  push(height, -0.75 * back, 0.85 * nose, 0.8 * head_wide, 3, {Part::kCap});
  push(height, 0.2 * nose, 0.2 * nose, 0, 2, {Part::kCap, 0});
  std::vector<RingSpec> specs;
  for (const auto& level : levels) specs.push_back(level.spec);
  const auto circle = unit_circle(kColumns);
  const Window window{window_row, window_row + 2, 0, 1};
  SurfaceBuilder builder;
  const auto rings = builder.sweep(specs, kColumns, [&](std::size_t r, int column) -> Eigen::Vector3d {
    const auto& level = levels[r];
    const Eigen::Vector2d e = superellipse(circle[static_cast<std::size_t>(column)], level.n);
    return {0.5 * (level.x0 + level.x1) + 0.5 * (level.x1 - level.x0) * e.x(), level.half_y * e.y(), level.z};
  }, {{window}});
  // The trigger: forward from the neck, then down.
  std::vector<TubeSection> lever;
  const double z0 = mix(neck_low, head_low, 0.62), half = 0.016 * height;
  const Eigen::Vector2d path[] = {{0.35, 0.0}, {0.62, -0.12}, {0.8, -0.4}, {0.92, -0.75}, {1.02, -1.0}};
  for (std::size_t i = 0; i < std::size(path); ++i) {
    const Eigen::Vector2d next = i + 1 < std::size(path) ? path[i + 1] : path[i], last = i > 0 ? path[i - 1] : Eigen::Vector2d::Zero();
    const Eigen::Vector2d travel = Eigen::Vector2d((next.x() - last.x()) * 0.75 * a, (next.y() - last.y()) * trigger).normalized();
    lever.push_back({{neck + 0.75 * a * path[i].x(), 0, z0 + trigger * path[i].y()}, {travel.y(), 0, -travel.x()}, {0, 1, 0}, half * 0.8, 0.55 * neck, 2.4});
  }
  builder.stub(SurfaceBuilder::window_loop(rings, window), lever, lever.back().centre + Eigen::Vector3d(0.003, 0, -0.006), Part::kSpout);
  return builder.finish({width, width * flat, height});
}

/// Wheels on the table, driving towards +x.
FamilyShape make_toy_car(ParameterDraw& draw) {
  const double length = draw.log_range(0.06, 0.26), half_width = length * draw.range(0.17, 0.24), height = length * draw.range(0.26, 0.42);
  const double wheel = length * draw.range(0.075, 0.115), clearance = wheel * draw.range(0.4, 0.75), wheel_half = half_width * draw.range(0.1, 0.2);
  const double hood = draw.range(0.5, 0.68), trunk = draw.range(0.5, 0.95), cabin_front = draw.range(0.1, 0.25), cabin_back = draw.range(-0.4, -0.22), squareness = draw.range(3.0, 5.0);
  const double front_axle = 0.3, rear_axle = -0.3, half_arch = 0.05;
  const Spline top({-0.5, -0.46, cabin_back, cabin_back + 0.12, cabin_front - 0.02, cabin_front + 0.13, 0.44, 0.5},
                   {0.7 * trunk, trunk, std::max(trunk, 0.75), 1.0, 1.0, hood, 0.9 * hood, 0.6 * hood});
  std::vector<LoftSection> sections;
  std::vector<double> stations{-0.5, -0.47, -0.41, rear_axle - half_arch, rear_axle, rear_axle + half_arch, -0.17, -0.1, -0.02, 0.06, 0.13, 0.2,
                               front_axle - half_arch, front_axle, front_axle + half_arch, 0.41, 0.47, 0.5};
  for (const double s : stations) {
    const double end = std::abs(s) > 0.49 ? 0.85 : 1.0;
    sections.push_back(section_x(length * s, end * half_width, clearance, std::max(height * top(s), clearance + 1.4 * wheel), squareness));
  }
  constexpr int kColumns = 20;
  const Window windows[] = {{3, 5, 0, 2}, {12, 14, 0, 2}, {3, 5, kColumns / 2, 2}, {12, 14, kColumns / 2, 2}};
  SurfaceBuilder builder;
  const auto rings = add_loft(builder, sections, kColumns, {std::begin(windows), std::end(windows)}, 0.002);
  for (std::size_t w = 0; w < 4; ++w) {
    const double side = w < 2 ? 1 : -1, x = length * (w % 2 == 0 ? rear_axle : front_axle);
    std::vector<TubeSection> tyre;
    const auto disc = [&](double out, double radius) {
      tyre.push_back({{x, side * (half_width + out), wheel}, {-1, 0, 0}, {0, 0, side}, radius, radius, 2});
    };
    disc(0.25 * wheel_half, 0.55 * wheel);
    disc(0.5 * wheel_half, 0.92 * wheel);
    disc(0.75 * wheel_half, wheel);
    disc(2.2 * wheel_half, wheel);
    disc(2.5 * wheel_half, 0.85 * wheel);
    builder.stub(SurfaceBuilder::window_loop(rings, windows[w]), tyre, tyre.back().centre, Part::kSpout);
  }
  FamilyShape car = builder.finish({length, 2 * half_width, height});
  return car;
}

}  // namespace gfp
