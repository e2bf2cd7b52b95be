#include "primitive/vessel.hpp"

#include <numbers>

namespace gfp {
namespace {

/// Rows of the outer wall that a handle's roots occupy: low - edge, low, low + edge, middle, high - edge, high, high + edge.
constexpr std::size_t kRootRows = 7;
constexpr double kRootFlare = 1.3;  // the root is that much wider than the strap

struct WallRow {
  double height_m = 0;  ///< All round.
  double local_m = 0;   ///< In the handle's plane: rows gather at its roots.
};

std::vector<WallRow> wall_rows(const Vessel& vessel, double top_m) {
  std::vector<WallRow> rows;
  for (int i = 0; i < vessel.outer_rows; ++i) {
    const double height = mix(vessel.base_edge_m, top_m, static_cast<double>(i) / (vessel.outer_rows - 1));
    rows.push_back({height, height});
  }
  if (!vessel.handle) return rows;
  const auto& handle = *vessel.handle;
  const double edge = kRootFlare * handle.half_thickness_m;
  const double local[kRootRows] = {handle.low_m - edge, handle.low_m, handle.low_m + edge, 0.5 * (handle.low_m + handle.high_m),
                                   handle.high_m - edge, handle.high_m, handle.high_m + edge};
  const std::size_t first = (rows.size() - kRootRows) / 2;
  for (std::size_t i = 0; i < kRootRows; ++i) rows[first + i].local_m = local[i];
  for (std::size_t i = 1; i < first; ++i) rows[i].local_m = mix(rows[0].height_m, local[0], static_cast<double>(i) / static_cast<double>(first));
  const std::size_t last = first + kRootRows - 1, above = rows.size() - 1 - last;
  for (std::size_t i = 1; i < above; ++i) rows[last + i].local_m = mix(local[kRootRows - 1], rows.back().height_m, static_cast<double>(i) / static_cast<double>(above));
  return rows;
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
    const double wall = mix(vessel.radius_m(handle.low_m / vessel.height_m), vessel.radius_m(handle.high_m / vessel.height_m), 0.5 + 0.5 * p.y());
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
  const double t = vessel.thickness_m, height = vessel.height_m;
  const auto outer = [&](double z) { return vessel.radius_m(z / height); };
  const auto rows = wall_rows(vessel, height - 0.5 * t);

  std::vector<ProfileRing> profile;
  append_disc(profile, outer(0) - vessel.base_edge_m, 0, Part::kBase, false, vessel.base_dome_m);
  profile.push_back({outer(0) - vessel.base_edge_m, 0, {Part::kBase}});
  const std::size_t wall = profile.size();
  for (const auto& row : rows) profile.push_back({outer(row.height_m), row.height_m, {Part::kBody}});
  const std::size_t rim = profile.size();
  profile.push_back({outer(height) - 0.5 * t, height, {Part::kRim}});
  for (int i = 0; i < vessel.inner_rows; ++i) {
    const double z = mix(height - 0.5 * t, vessel.floor_m + 1.5 * t, static_cast<double>(i) / (vessel.inner_rows - 1));
    profile.push_back({outer(z) - t, z, {i == 0 ? Part::kRim : Part::kInnerWall}});
  }
  profile[rim - 1].spec.part = Part::kRim;
  const double floor_radius = outer(vessel.floor_m) - 2.5 * t;
  profile.push_back({floor_radius, vessel.floor_m, {Part::kInnerWall}});
  append_disc(profile, floor_radius, vessel.floor_m, Part::kInnerWall, true);

  const double root_angle = vessel.handle ? std::asin(std::min(0.5, 1.2 * vessel.handle->half_width_m / outer(vessel.handle->low_m))) : 0;
  const auto directions = vessel.handle ? circle_with_root(vessel.columns, root_angle) : unit_circle(vessel.columns);
  std::vector<RingSpec> specs;
  for (const auto& ring : profile) specs.push_back(ring.spec);
  const auto place = [&](std::size_t r, int column) -> Eigen::Vector3d {
    const auto& direction = directions[static_cast<std::size_t>(column)];
    double z = profile[r].height_m, radius = profile[r].radius_m;
    if (r >= wall && r < rim) {
      const double near_handle = vessel.handle ? 1 - smooth_step(root_angle, root_angle + 0.9, std::acos(std::clamp(direction.x(), -1.0, 1.0))) : 0;
      z = mix(z, rows[r - wall].local_m, near_handle);
      radius = outer(z);
    }
    radius += lip_reach(vessel, direction, z);
    return {radius * direction.x(), radius * direction.y(), z};
  };

  SweepOptions options;
  options.rim = rim;
  const std::size_t first = wall + (rows.size() - kRootRows) / 2;
  if (vessel.handle) options.windows = {{first, first + 2}, {first + 4, first + 6}};
  SurfaceBuilder builder;
  const auto rings = builder.sweep(specs, vessel.columns, place, options);
  if (vessel.handle)
    builder.tube(SurfaceBuilder::window_loop(rings, options.windows[0]), handle_sections(vessel), SurfaceBuilder::window_loop(rings, options.windows[1], true), Part::kHandle);

  double widest = 0;
  for (const auto& row : rows) widest = std::max(widest, outer(row.height_m));
  return builder.finish({2 * widest, 2 * widest, height});
}

}  // namespace gfp
