#include "segmentation/supports.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gfp/core/convex_hull.hpp"

namespace gfp {
namespace {

constexpr double kUpCos = 0.87;           // a support's normal is within 30 deg of the accelerometer's up
constexpr double kLevelCos = 0.985;       // supports are level with each other within 10 deg
constexpr double kLooksDownCos = 0.25;    // a table seen by a camera that is not rolled: its normal points up in the image
constexpr double kFacesCos = 0.85;        // a table seen from straight above, or a wall seen squarely
constexpr double kFacingWeight = 0.1;     // of such a surface, against one that surely is level
constexpr int kMinSupportCells = 10;      // of the 1200 of a 640 x 480 frame
constexpr std::size_t kMaxSupports = 4, kMaxWalls = 4;

using Outline = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

double diameter(const Outline& outline) {
  double squared = 0;
  for (const auto& a : outline)
    for (const auto& b : outline) squared = std::max(squared, (a - b).squaredNorm());
  return std::sqrt(squared);
}

double area(const Outline& outline) {
  double doubled = 0;
  for (std::size_t i = 2; i < outline.size(); ++i) doubled += cross(outline[0], outline[i - 1], outline[i]);
  return 0.5 * doubled;
}

// z along `up`; x along the image's x as far as the plane allows, so that the frame is the same from frame to frame.
Transform support_frame(const PlaneFit& fit, const Eigen::Vector3d& near_point) {
  const Eigen::Vector3d up = fit.up();
  const Eigen::Vector3d across = std::abs(up.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d x = (across - up * up.dot(across)).normalized();
  Transform T_camera_support = Transform::Identity();
  T_camera_support.linear().col(0) = x;
  T_camera_support.linear().col(1) = up.cross(x);
  T_camera_support.linear().col(2) = up;
  T_camera_support.translation() = near_point - up * (up.dot(near_point) + fit.camera_height_m());
  return T_camera_support;
}

struct Surface {
  PlaneFit fit;
  Ground ground;
  SupportPlane plane;
  double noise_inverse_m = 0;  // what one reading errs, as a residual of 1/z
  double weight = 0;           // how surely it is a support
};

double median_noise(const CellGrid& cells, const FlatRegion& region) {
  std::vector<double> noise;
  for (const int c : region.cells) noise.push_back(cells[c].fit.rms_inverse_m);
  std::nth_element(noise.begin(), noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 2), noise.end());
  return std::sqrt(16.0 / 13.0) * noise[noise.size() / 2];  // a cell's fit uses up 3 of its 16 readings
}

// The samples of the region's cells and of the cells beside them that lie on the surface, ascending.
std::vector<std::size_t> samples_on(const SampleGrid& grid, const CellGrid& cells, const FlatRegion& region, const Surface& surface) {
  std::vector<std::uint8_t> near(cells.cells.size(), 0);
  for (const int c : region.cells) {
    near[static_cast<std::size_t>(c)] = 1;
    cells.neighbours(c, [&](int n) { near[static_cast<std::size_t>(n)] = 1; });
  }
  std::vector<std::size_t> samples;
  const double size = surface.fit.coefficients.norm();
  for (int j = 0; j < grid.height; ++j)
    for (int i = 0; i < grid.width; ++i) {
      const int c = std::min(i / kCellSamples, cells.columns - 1), r = std::min(j / kCellSamples, cells.rows - 1);
      const auto cell = static_cast<std::size_t>(r * cells.columns + c), s = grid.index(i, j);
      if (near[cell] == 0 || !grid.valid(s)) continue;
      const double w = grid.inverse_depth[s];
      const double residual = surface.fit.residual(grid.ray_x[s], grid.ray_y[s], w) - static_cast<double>(surface.ground.offset_m[cell]) * w * size;
      if (std::abs(residual) <= flatness_tolerance(w)) samples.push_back(s);
    }
  return samples;
}

// Only the first and last sample of a row can lie on the convex outline: lines stay lines in the image.
Surface describe(const SampleGrid& grid, const CellGrid& cells, const FlatRegion& region) {
  Surface surface{region.fit, ground_of(cells, region, grid.stride * kCellSamples), {}, median_noise(cells, region), 0};
  const auto samples = samples_on(grid, cells, region, surface);
  if (samples.empty()) return surface;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double squares = 0;
  for (const auto s : samples) {
    const Eigen::Vector3d point = grid.point(s);
    centre += point;
    const double height = surface.fit.up().dot(point) + surface.fit.camera_height_m();
    squares += height * height;
  }
  const auto count = static_cast<double>(samples.size());
  surface.plane.T_camera_support = support_frame(surface.fit, centre / count);
  surface.plane.rms_m = std::sqrt(squares / count);
  surface.plane.inliers = static_cast<int>(samples.size()) * grid.stride * grid.stride;
  const Transform T_support_camera = surface.plane.T_camera_support.inverse();
  const auto width = static_cast<std::size_t>(grid.width);
  Outline ends;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool first = k == 0 || samples[k - 1] / width != samples[k] / width;
    const bool last = k + 1 == samples.size() || samples[k + 1] / width != samples[k] / width;
    if (first || last) ends.push_back((T_support_camera * grid.point(samples[k])).head<2>());
  }
  surface.plane.polygon = convex_hull(std::move(ends));
  return surface;
}

double support_weight(const Surface& surface, const std::optional<Eigen::Vector3d>& up_camera) {
  const Eigen::Vector3d up = surface.fit.up();
  const double size = area(surface.plane.polygon);
  if (up_camera) return up.dot(*up_camera) >= kUpCos ? size : 0.0;
  if (-up.y() >= kLooksDownCos) return size;
  return -up.z() >= kFacesCos && -up.y() > -kLooksDownCos ? kFacingWeight * size : 0.0;
}

FlatSurface flat_surface(const Surface& surface, const SegmentationOptions& options) {
  FlatSurface flat{surface.fit.up(), surface.fit.camera_height_m(), 0, 0, surface.ground, {}, {}, {}};
  // Three and a half times the noise that the surface itself shows, within what the options allow.
  flat.band_per_m2 = std::min(3.5 * std::max(surface.noise_inverse_m, 0.0006), options.plane_inlier_m);
  flat.band_m = std::min(0.002, 0.5 * options.plane_inlier_m);
  const auto& outline = surface.plane.polygon;
  const Transform& T = surface.plane.T_camera_support;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    flat.corners.push_back(T * Eigen::Vector3d(outline[i].x(), outline[i].y(), 0));
    const Eigen::Vector2d along = outline[(i + 1) % outline.size()] - outline[i];
    if (along.norm() < 1e-6) continue;
    const Eigen::Vector2d inner = Eigen::Vector2d(-along.y(), along.x()).normalized();
    const Eigen::Vector3d edge = T.linear().leftCols<2>() * inner;
    flat.edges.push_back(edge);
    flat.edge_offsets_m.push_back(-edge.dot(flat.corners.back()));
  }
  return flat;
}

// A level surface smaller than an object, low above a support: the top of something.
bool is_object_top(const Surface& surface, const std::vector<const Surface*>& supports, const SegmentationOptions& options) {
  if (diameter(surface.plane.polygon) > options.max_size_m) return false;
  const Eigen::Vector3d centre = surface.plane.T_camera_support.translation();
  return std::any_of(supports.begin(), supports.end(), [&](const Surface* below) {
    const double rise = below->fit.up().dot(centre) + below->fit.camera_height_m();
    return rise > 0 && rise <= options.max_height_m;
  });
}

// On a crowded table the plane shows in scattered cells only, which no region can grow over: the last frame's finds them.
void add_known(const CellGrid& cells, const SupportPlane& last, std::vector<FlatRegion>& regions) {
  const Eigen::Vector3d up = last.T_camera_support.linear().col(2);
  const double camera_height = -up.dot(last.T_camera_support.translation());
  if (!(camera_height > 1e-3)) return;
  FlatRegion known = region_on_plane(cells, {-up / camera_height, last.rms_m});
  std::vector<std::uint8_t> taken(cells.cells.size(), 0);
  for (const FlatRegion& region : regions)
    for (const int c : region.cells) taken[static_cast<std::size_t>(c)] = 1;
  const auto free = std::count_if(known.cells.begin(), known.cells.end(), [&](int c) { return taken[static_cast<std::size_t>(c)] == 0; });
  if (2 * free > static_cast<long>(known.cells.size())) regions.push_back(std::move(known));
}

}  // namespace

double FlatSurface::inside(const Eigen::Vector3d& p) const {
  double least = 1e9;
  for (std::size_t i = 0; i < edges.size(); ++i) least = std::min(least, edges[i].dot(p) + edge_offsets_m[i]);
  return least;
}

Supports find_supports(const OrganizedCloud& cloud, const SegmentationOptions& options,
                       const std::optional<Eigen::Vector3d>& up_camera, const SupportPlane* last) {
  const SampleGrid grid = sample_grid(cloud);
  const CellGrid cells = fit_cells(grid);
  std::vector<FlatRegion> regions = flat_regions(cells);
  if (last != nullptr) add_known(cells, *last, regions);
  regions = join_surfaces(cells, std::move(regions));
  std::erase_if(regions, [](const FlatRegion& region) { return static_cast<int>(region.cells.size()) < kMinSupportCells; });
  std::vector<Surface> surfaces(regions.size());
  oneapi::tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t k) { surfaces[k] = describe(grid, cells, regions[k]); });
  std::erase_if(surfaces, [](const Surface& surface) { return surface.plane.polygon.size() < 3; });

  const Surface* main = nullptr;
  for (Surface& surface : surfaces) {
    surface.weight = support_weight(surface, up_camera);
    if (surface.weight > 0 && (main == nullptr || surface.weight > main->weight)) main = &surface;
  }
  Supports supports;
  const auto is_level = [&](const Surface& s) { return main != nullptr && s.fit.up().dot(main->fit.up()) >= kLevelCos; };
  // From the lowest to the highest, so that what something stands on is known before it.
  std::vector<const Surface*> level;
  for (const Surface& surface : surfaces)
    if (is_level(surface)) level.push_back(&surface);
  std::stable_sort(level.begin(), level.end(), [](const Surface* a, const Surface* b) { return a->fit.camera_height_m() > b->fit.camera_height_m(); });
  std::vector<const Surface*> accepted;
  for (const Surface* surface : level)
    if (surface == main || !is_object_top(*surface, accepted, options)) accepted.push_back(surface);
  std::stable_sort(accepted.begin(), accepted.end(), [](const Surface* a, const Surface* b) { return a->plane.inliers > b->plane.inliers; });
  if (accepted.size() > kMaxSupports) accepted.resize(kMaxSupports);
  for (const Surface* surface : accepted) {
    supports.planes.push_back(surface->plane);
    supports.surfaces.push_back(flat_surface(*surface, options));
  }
  for (const Surface& surface : surfaces)
    if (!is_level(surface) && supports.walls.size() < kMaxWalls && diameter(surface.plane.polygon) > options.max_size_m)
      supports.walls.push_back(flat_surface(surface, options));
  return supports;
}

}  // namespace gfp
