#include "primitive/vessel.hpp"

#include <numbers>

namespace gfp {
namespace {

constexpr double kRootFlare = 1.3;  // the root is that much wider than the strap

struct WallRow {
  double height_m = 0;  ///< All round.
  double local_m = 0;   ///< In the handle's plane: rows gather at its roots.
};

/// Heights of the rows that belong to the handle: three at every root, and those between two roots. Empty without a handle.
std::vector<double> root_heights(const Vessel& vessel) {
  if (vessel.bar) {
    const double root = vessel.bar->root_m, edge = kRootFlare * vessel.bar->half_thickness_m;
    return {root - edge, root, root + edge};
  }
  if (!vessel.handle) return {};
  const auto& handle = *vessel.handle;
  const double edge = kRootFlare * handle.half_thickness_m, low = handle.low_m + edge, high = handle.high_m - edge;
  std::vector<double> heights{handle.low_m - edge, handle.low_m, low};
  for (int i = 1; i <= handle.rows_between; ++i) heights.push_back(mix(low, high, static_cast<double>(i) / (handle.rows_between + 1)));
  heights.insert(heights.end(), {high, handle.high_m, handle.high_m + edge});
  return heights;
}

std::size_t first_root_row(const Vessel& vessel) { return (static_cast<std::size_t>(vessel.outer_rows) - root_heights(vessel).size()) / 2; }

std::vector<WallRow> wall_rows(const Vessel& vessel, double top_m) {
  std::vector<WallRow> rows;
  for (int i = 0; i < vessel.outer_rows; ++i) {
    const double height = mix(vessel.base_edge_m, top_m, static_cast<double>(i) / (vessel.outer_rows - 1));
    rows.push_back({height, height});
  }
  const auto roots = root_heights(vessel);
  if (roots.empty()) return rows;
  const std::size_t first = first_root_row(vessel), last = first + roots.size() - 1, above = rows.size() - 1 - last;
  for (std::size_t i = 0; i < roots.size(); ++i) rows[first + i].local_m = roots[i];
  for (std::size_t i = 1; i < first; ++i) rows[i].local_m = mix(rows[0].height_m, roots.front(), static_cast<double>(i) / static_cast<double>(first));
  for (std::size_t i = 1; i < above; ++i) rows[last + i].local_m = mix(roots.back(), rows.back().height_m, static_cast<double>(i) / static_cast<double>(above));
  return rows;
}

/// Half the angle that the handle's root takes of the wall; 0 without a handle.
double root_half_angle(const Vessel& vessel) {
  const double width = vessel.handle ? vessel.handle->half_width_m : vessel.bar ? 0.75 * vessel.bar->half_width_m : 0.0;
  const double height = vessel.handle ? vessel.handle->low_m : vessel.bar ? vessel.bar->root_m : 0.0;
  return std::asin(std::min(0.5, 1.2 * width / vessel.radius_m(height / vessel.height_m)));
}

double lip_reach(const Vessel& vessel, const Eigen::Vector2d& direction, double height_m) {
  if (!vessel.lip) return 0;
  const double angle = std::acos(std::clamp(-direction.x(), -1.0, 1.0));
  if (angle >= vessel.lip->half_angle_rad) return 0;
  const double across = std::cos(0.5 * std::numbers::pi * angle / vessel.lip->half_angle_rad);
  return vessel.lip->reach_m * across * across * smooth_step(vessel.lip->begin, 1.1, height_m / vessel.height_m);
}

std::vector<TubeSection> handle_sections(const Vessel& vessel) {
  const auto& handle = *vessel.handle;
  const double middle = 0.5 * (handle.low_m + handle.high_m), half = 0.5 * (handle.high_m - handle.low_m);
  std::vector<Eigen::Vector2d> arc;  // (x, z)
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / kSteps - 0.5);
    const Eigen::Vector2d p = superellipse({i % kSteps == 0 ? 0.0 : std::cos(angle), std::sin(angle)}, handle.squareness);
    const double height = middle + half * p.y();
    const double chord = mix(vessel.radius_m(handle.low_m / vessel.height_m), vessel.radius_m(handle.high_m / vessel.height_m), 0.5 + 0.5 * p.y());
    const double wall = std::max(chord, vessel.radius_m(height / vessel.height_m));  // a belly must not touch its handle
    arc.emplace_back(wall + handle.reach_m * p.x() * (1 + handle.skew * p.y()), height);
  }
  const auto points = resample(arc, handle.sections + 2);
  std::vector<TubeSection> sections;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d travel = (points[i + 1] - points[i - 1]).normalized();
    sections.push_back({{points[i].x(), 0, points[i].y()}, {travel.y(), 0, -travel.x()}, {0, 1, 0}, handle.half_thickness_m, handle.half_width_m, 2.5});
  }
  return sections;
}

std::vector<TubeSection> bar_sections(const Vessel& vessel) {
  const auto& bar = *vessel.bar;
  const double wall = vessel.radius_m(bar.root_m / vessel.height_m);
  const Eigen::Vector3d travel = Eigen::Vector3d(bar.length_m, 0, bar.rise_m).normalized();
  std::vector<TubeSection> sections;
  constexpr int kSections = 9;
  for (int i = 1; i <= kSections; ++i) {
    const double u = static_cast<double>(i) / kSections, end = i == kSections ? 0.6 : 1.0;  // the last one rounds the end
    sections.push_back({{wall + bar.length_m * (i == kSections ? 0.99 : u), 0, bar.root_m + bar.rise_m * u}, {travel.z(), 0, -travel.x()}, {0, 1, 0},
                        end * bar.half_thickness_m, end * bar.half_width_m * mix(0.75, 1.0, smooth_step(0.1, 0.6, u)), 2.6});
  }
  return sections;
}

/// Grows what the vessel carries from the windows left for it.
void attach_handle(SurfaceBuilder& builder, const Vessel& vessel, const std::vector<Ring>& rings, const std::vector<Window>& windows) {
  if (vessel.bar) {
    const auto sections = bar_sections(vessel);
    const Eigen::Vector3d tip = sections.back().centre + 0.012 * vessel.bar->length_m * Eigen::Vector3d::UnitX();
    builder.stub(SurfaceBuilder::window_loop(rings, windows[0]), sections, tip, Part::kHandle);
  } else if (vessel.handle) {
    builder.tube(SurfaceBuilder::window_loop(rings, windows[0]), handle_sections(vessel), SurfaceBuilder::window_loop(rings, windows[1], true), Part::kHandle);
  }
}

/// Bottom, outer wall, rim, inner wall and floor; `wall` and `rim` are the first rings of the outer wall and of what is above it.
struct VesselProfile {
  std::vector<ProfileRing> rings;
  std::size_t wall = 0, rim = 0;
};

VesselProfile vessel_profile(const Vessel& vessel, const std::vector<WallRow>& rows) {
  const double t = vessel.thickness_m, height = vessel.height_m;
  const auto outer = [&](double z) { return vessel.radius_m(z / height); };
  VesselProfile profile;
  auto& rings = profile.rings;
  append_disc(rings, outer(0) - vessel.base_edge_m, 0, Part::kBase, false);
  rings.push_back({outer(0) - vessel.base_edge_m, 0, {Part::kBase}});
  profile.wall = rings.size();
  for (const auto& row : rows) rings.push_back({outer(row.height_m), row.height_m, {Part::kBody}});
  rings.back().spec.part = Part::kRim;
  profile.rim = rings.size();
  rings.push_back({outer(height) - 0.5 * t, height, {Part::kRim}});
  for (int i = 0; i < vessel.inner_rows; ++i) {
    const double z = mix(height - 0.5 * t, vessel.floor_m + 1.5 * t, static_cast<double>(i) / (vessel.inner_rows - 1));
    rings.push_back({outer(z) - t, z, {i == 0 ? Part::kRim : Part::kInnerWall}});
  }
  const double floor_radius = outer(vessel.floor_m) - 2.5 * t;
  rings.push_back({floor_radius, vessel.floor_m, {Part::kInnerWall}});
  append_disc(rings, floor_radius, vessel.floor_m, Part::kInnerWall, true);
  return profile;
}

}  // namespace

void append_disc(std::vector<ProfileRing>& profile, double radius_m, double height_m, Part part, bool inwards, double dome_m) {
  constexpr std::size_t kCount = std::size(kDisc);
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto& [stride, share] = kDisc[inwards ? kCount - 1 - i : i];
    profile.push_back({radius_m * share, height_m + dome_m * (1 - share * share), {part, stride}});
  }
}

FamilyShape build_lathe(const std::vector<ProfileRing>& profile, int columns, std::size_t rim, const Eigen::Vector3d& reference_size_m) {
  const auto circle = unit_circle(columns);
  std::vector<RingSpec> specs;
  for (const auto& ring : profile) specs.push_back(ring.spec);
  SurfaceBuilder builder;
  builder.sweep(specs, columns, [&](std::size_t r, int column) {
    const auto& direction = circle[static_cast<std::size_t>(column)];
    return Eigen::Vector3d(profile[r].radius_m * direction.x(), profile[r].radius_m * direction.y(), profile[r].height_m);
  }, {{}, rim});
  return builder.finish(reference_size_m);
}

FamilyShape build_vessel(const Vessel& vessel) {
  const auto rows = wall_rows(vessel, vessel.height_m - 0.5 * vessel.thickness_m);
  const VesselProfile profile = vessel_profile(vessel, rows);
  const auto outer = [&](double z) { return vessel.radius_m(z / vessel.height_m); };
  const double root_angle = root_half_angle(vessel);
  const bool handled = root_angle > 0;
  const auto directions = handled ? circle_with_root(vessel.columns, root_angle) : unit_circle(vessel.columns);
  std::vector<RingSpec> specs;
  for (const auto& ring : profile.rings) specs.push_back(ring.spec);
  const auto place = [&](std::size_t r, int column) -> Eigen::Vector3d {
    const auto& direction = directions[static_cast<std::size_t>(column)];
    double z = profile.rings[r].height_m, radius = profile.rings[r].radius_m;
    if (handled && r >= profile.wall && r < profile.rim) {
      const double away = std::acos(std::clamp(direction.x(), -1.0, 1.0));
      z = mix(rows[r - profile.wall].local_m, z, smooth_step(root_angle, root_angle + 0.9, away));
      radius = outer(z);
    }
    radius += lip_reach(vessel, direction, z);
    return {radius * direction.x(), radius * direction.y(), z};
  };

  SweepOptions options{{}, profile.rim};
  if (handled) {
    const std::size_t low = profile.wall + first_root_row(vessel);
    options.windows.push_back({low, low + 2});
    if (vessel.handle) options.windows.push_back({low + static_cast<std::size_t>(vessel.handle->rows_between) + 3, low + static_cast<std::size_t>(vessel.handle->rows_between) + 5});
  }
  SurfaceBuilder builder;
  const auto rings = builder.sweep(specs, vessel.columns, place, options);
  if (handled) attach_handle(builder, vessel, rings, options.windows);

  double widest = 0;
  for (const auto& row : rows) widest = std::max(widest, outer(row.height_m));
  return builder.finish({2 * widest, 2 * widest, vessel.height_m});
}

}  // namespace gfp
