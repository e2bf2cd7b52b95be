// Fruit and balls: ball (apple, orange), banana.
#include <numbers>

#include "primitive/loft.hpp"
#include "primitive/vessel.hpp"

namespace gfp {

FamilyShape make_ball(ParameterDraw& draw) {
  const double width = draw.log_range(0.038, 0.23), radius = 0.5 * width, height = width * draw.range(0.78, 1.15);
  const double dimple_high = draw.range(-0.02, 0.16), dimple_low = draw.range(-0.02, 0.1);  // an apple's; < 0: a lemon's tips
  const double egg = draw.range(-0.12, 0.12), squareness = draw.range(1.9, 2.4);
  constexpr int kColumns = 32, kSteps = 16;
  std::vector<ProfileRing> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;  // from the south pole
    const int stride = i == 0 || i == kSteps ? 0 : i == 1 || i + 1 == kSteps ? 4 : i == 2 || i + 2 == kSteps ? 2 : 1;
    const Eigen::Vector2d p = superellipse({i % kSteps == 0 ? 0.0 : std::sin(angle), -std::cos(angle)}, squareness);
    const double high = std::pow(std::max(p.y(), 0.0), 6), low = std::pow(std::max(-p.y(), 0.0), 6);
    const double z = 0.5 * height * (p.y() - dimple_high * high + dimple_low * low);
    profile.push_back({radius * p.x() * (1 + egg * p.y()), 0.5 * height + z, {i == 0 ? Part::kBase : Part::kBody, stride}});
  }
  double low = height, high = 0, widest = 0;
  for (const auto& ring : profile) {
    low = std::min(low, ring.height_m);
    high = std::max(high, ring.height_m);
    widest = std::max(widest, 2 * ring.radius_m);
  }
  for (auto& ring : profile) ring.height_m -= low;
  return build_lathe(profile, kColumns, kNoRim, {widest, widest, high - low});
}

/// Lies on its side: an arc in the horizontal plane, symmetric about its middle plane z = height / 2.
FamilyShape make_banana(ParameterDraw& draw) {
  const double length = draw.log_range(0.13, 0.25), bend = draw.range(0.7, 2.0), radius = length * draw.range(0.075, 0.11);
  const double stem = draw.range(0.25, 0.45), blunt = draw.range(0.3, 0.6), fullness = draw.range(0.75, 1.05), squareness = draw.range(1.9, 2.4);
  const double shift = draw.range(-0.3, 0.3);  // where along its length it bends most
  const Spline girth({0, 0.07, 0.2, 0.5, 0.8, 0.92, 1}, {stem, stem, 0.5 * (fullness + stem), 1.0, fullness, 0.5 * (fullness + blunt), 0.55 * blunt});
  constexpr int kSections = 30, kColumns = 16;
  std::vector<LoftSection> sections;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double heading = 0.5 * bend;
  for (int i = 0; i < kSections; ++i) {
    const double u = i / (kSections - 1.0);
    const Eigen::Vector3d travel(std::cos(heading), std::sin(heading), 0), across(-travel.y(), travel.x(), 0);
    const double r = radius * girth(u);
    sections.push_back({at, r * across, r * Eigen::Vector3d::UnitZ(), squareness, u < 0.1 ? Part::kNeck : Part::kBody, 0});
    at += length / (kSections - 1) * travel;
    heading -= bend / (kSections - 1) * (1 + shift * std::cos(2 * std::numbers::pi * u));
  }
  SurfaceBuilder builder;
  add_loft(builder, sections, kColumns, {}, 0.15 * radius);
  FamilyShape banana = builder.finish({length, length, 2 * radius});
  const Bounds box = bounds(banana.mesh.vertices);
  for (auto& p : banana.mesh.vertices) p -= Eigen::Vector3d(box.centre().x(), box.centre().y(), box.low.z());
  banana.reference_size_m = box.size();
  return banana;
}

}  // namespace gfp
