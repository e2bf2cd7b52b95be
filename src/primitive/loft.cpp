#include "primitive/loft.hpp"

#include "primitive/curves.hpp"

namespace gfp {

std::vector<Ring> add_loft(SurfaceBuilder& builder, const std::vector<LoftSection>& sections, int columns, const std::vector<Window>& windows, double bulge_m) {
  const auto circle = unit_circle(columns);
  std::vector<RingSpec> specs{{sections.front().part, 0}};
  for (const auto& section : sections) specs.push_back({section.part, 1});
  specs.push_back({sections.back().part, 0});
  const auto place = [&](std::size_t r, int column) -> Eigen::Vector3d {
    const auto travel = [](const LoftSection& section) { return section.u.cross(section.v).normalized(); };
    if (r == 0) return sections.front().centre - bulge_m * travel(sections.front()) ;
    if (r > sections.size()) return sections.back().centre + bulge_m * travel(sections.back());
    const auto& section = sections[r - 1];
    const Eigen::Vector2d e = superellipse(circle[static_cast<std::size_t>(column)], section.squareness);
    return section.centre + e.x() * section.u + e.y() * section.v + section.sag_m * e.x() * e.x() * Eigen::Vector3d::UnitZ();
  };
  SweepOptions options;
  for (auto window : windows) {  // the caller counts sections, the sweep also the pole
    ++window.ring_low;
    ++window.ring_high;
    options.windows.push_back(window);
  }
  auto rings = builder.sweep(specs, columns, place, options);
  return {rings.begin() + 1, rings.end() - 1};
}

LoftSection section_x(double x, double half_width, double z_low, double z_high, double squareness, Part part) {
  return {{x, 0, 0.5 * (z_low + z_high)}, {0, half_width, 0}, {0, 0, 0.5 * (z_high - z_low)}, squareness, part, 0};
}

}  // namespace gfp
