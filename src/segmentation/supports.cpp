#include "segmentation/supports.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gfp {
namespace {

constexpr double kUpCos = 0.87;           // a support's normal is within 30 deg of the accelerometer's up
constexpr double kLevelCos = 0.985;       // supports are level with each other within 10 deg
constexpr double kLooksDownCos = 0.25;    // a table seen by a camera that is not rolled: its normal points up in the image
constexpr double kFacesCos = 0.85;        // a table seen from straight above, or a wall seen squarely
constexpr double kFacingWeight = 0.1;     // of such a surface, against one that surely is level
constexpr int kMinSupportSamples = 150;   // of the 19200 of a 640 x 480 frame
constexpr std::size_t kMaxSupports = 4, kMaxWalls = 4;

using Outline = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// Andrew's monotone chain; counter-clockwise, without collinear points.
Outline convex_hull(Outline points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  if (points.size() < 3) return points;
  Outline hull;
  const auto half = [&](auto first, auto end) {
    const std::size_t base = hull.size();
    for (auto p = first; p != end; ++p) {
      while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return hull;
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
  SupportPlane plane;
  double weight = 0;  // how surely it is a support
};

// Only the first and last reading of a sampled row can lie on the convex outline: lines stay lines in the image.
Surface describe(const SampleGrid& grid, const PlaneCandidate& candidate) {
  Surface surface{candidate.fit, {}, 0};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double squares = 0;
  for (const auto s : candidate.samples) {
    const Eigen::Vector3d point = grid.point(static_cast<std::size_t>(s));
    centre += point;
    const double height = candidate.fit.up().dot(point) + candidate.fit.camera_height_m();
    squares += height * height;
  }
  const auto count = static_cast<double>(candidate.samples.size());
  surface.plane.T_camera_support = support_frame(candidate.fit, centre / count);
  surface.plane.rms_m = std::sqrt(squares / count);
  surface.plane.inliers = static_cast<int>(candidate.samples.size()) * grid.stride * grid.stride;
  const Transform T_support_camera = surface.plane.T_camera_support.inverse();
  Outline ends;
  for (std::size_t k = 0; k < candidate.samples.size(); ++k) {
    const auto row = candidate.samples[k] / grid.width;
    const bool first = k == 0 || candidate.samples[k - 1] / grid.width != row;
    const bool last = k + 1 == candidate.samples.size() || candidate.samples[k + 1] / grid.width != row;
    if (first || last) ends.push_back((T_support_camera * grid.point(static_cast<std::size_t>(candidate.samples[k]))).head<2>());
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
  FlatSurface flat{surface.fit.up(), surface.fit.camera_height_m(), 0, 0, {}, {}};
  // Three and a half times the noise that the plane itself shows, within what the options allow.
  const double noise = std::min(3.5 * std::max(surface.fit.rms_inverse_m, 0.0006), options.plane_inlier_m);
  flat.band_m = std::min(0.002, 0.5 * options.plane_inlier_m);
  flat.band_per_m2 = noise;
  const auto& outline = surface.plane.polygon;
  const Transform& T = surface.plane.T_camera_support;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d along = outline[(i + 1) % outline.size()] - outline[i];
    if (along.norm() < 1e-6) continue;
    const Eigen::Vector2d inner = Eigen::Vector2d(-along.y(), along.x()).normalized();
    const Eigen::Vector3d edge = T.linear().leftCols<2>() * inner;
    flat.edges.push_back(edge);
    flat.edge_offsets_m.push_back(-edge.dot(T * Eigen::Vector3d(outline[i].x(), outline[i].y(), 0)));
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

std::optional<PlaneFit> fit_of(const SupportPlane& plane) {
  const Eigen::Vector3d up = plane.T_camera_support.linear().col(2);
  const double camera_height = -up.dot(plane.T_camera_support.translation());
  if (!(camera_height > 1e-3)) return std::nullopt;
  return PlaneFit{-up / camera_height, plane.rms_m};
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
  std::vector<Surface> surfaces;
  for (const PlaneCandidate& candidate : plane_candidates(grid)) {
    if (static_cast<int>(candidate.samples.size()) < kMinSupportSamples) break;
    surfaces.push_back(describe(grid, candidate));
    if (surfaces.back().plane.polygon.size() < 3) surfaces.pop_back();
  }
  (void)last;
  (void)fit_of;

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
