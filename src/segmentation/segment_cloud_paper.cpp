#include "gfp/segmentation/segment_cloud_paper.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/core/convex_hull.hpp"
#include "segmentation/outline.hpp"
#include "segmentation/pcl_parts.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kMaxPlanes = 3;
constexpr double kUpCosine = 0.866;           ///< A support is level within 30 degrees where up is known...
constexpr double kSeenFromAboveCosine = 0.26; ///< ...else its normal is within 75 degrees of the image's up.
constexpr std::size_t kOutlineStride = 16;    ///< Of the inliers that the outline is drawn around.
constexpr double kOutlineGapM = 0.05;         ///< Parts of a plane farther apart are other surfaces at the same height.
constexpr float kMinDepthM = 0.05F;

/// Some of the cloud's points with their pixels.
struct Points {
  std::vector<Vector3f> points;
  std::vector<std::int32_t> pixels;

  void add(const OrganizedCloud& cloud, std::int32_t pixel) {
    points.push_back(cloud.point(static_cast<std::size_t>(pixel)));
    pixels.push_back(pixel);
  }
};

Points readings(const OrganizedCloud& cloud, double max_depth_m) {
  Points all;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.z[i] >= kMinDepthM && static_cast<double>(cloud.z[i]) <= max_depth_m) all.add(cloud, static_cast<std::int32_t>(i));
  return all;
}

/// A support plane in the form of the result and in the form for tests of points.
struct Support {
  SupportPlane plane;
  FlatSurface surface;
  std::vector<std::int32_t> pixels;
};

/// The inliers' greatest connected part, thinned.
std::vector<Vector3d> outline_points(const std::vector<Vector3f>& points, const std::vector<std::int32_t>& inliers) {
  std::vector<Vector3f> thin;
  for (std::size_t k = 0; k < inliers.size(); k += kOutlineStride) thin.push_back(points[static_cast<std::size_t>(inliers[k])]);
  std::vector<Vector3d> outline;
  const auto parts = euclidean_clusters(thin, kOutlineGapM, 1);
  for (const std::int32_t i : parts.empty() ? std::vector<std::int32_t>{} : parts.front()) outline.push_back(thin[static_cast<std::size_t>(i)].cast<double>());
  return outline;
}

Support make_support(const Points& points, const PlaneInliers& plane) {
  Support support;
  const Vector3d up = plane.offset_m > 0 ? plane.normal : Vector3d(-plane.normal);  // the camera is above it
  const double camera_height = std::abs(plane.offset_m);
  const std::vector<Vector3d> outline = outline_points(points.points, plane.inliers);
  Vector3d origin = Vector3d::Zero();
  for (const auto& p : outline) origin += p / static_cast<double>(outline.size());
  origin -= (up.dot(origin) + camera_height) * up;
  const auto [x, y] = orthonormal_basis(up);
  Transform& T_camera_support = support.plane.T_camera_support;
  T_camera_support.linear() << x, y, up;
  T_camera_support.translation() = origin;
  std::vector<Eigen::Vector2d> flat;
  const Transform T_support_camera = T_camera_support.inverse();
  for (const auto& p : outline) flat.emplace_back((T_support_camera * p).head<2>());
  support.plane.polygon = convex_hull(std::move(flat));
  support.plane.inliers = static_cast<int>(plane.inliers.size());
  double squared = 0;
  for (const std::int32_t i : plane.inliers) {
    const double height = up.dot(points.points[static_cast<std::size_t>(i)].cast<double>()) + camera_height;
    squared += height * height;
    support.pixels.push_back(points.pixels[static_cast<std::size_t>(i)]);
  }
  support.plane.rms_m = std::sqrt(squared / static_cast<double>(std::max<std::size_t>(1, plane.inliers.size())));

  FlatSurface& surface = support.surface;
  surface.up = up;
  surface.camera_height_m = camera_height;
  surface.ground = {1, 1, 1, {0.0F}};
  const auto& polygon = support.plane.polygon;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d edge = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    const Vector3d corner = T_camera_support * Vector3d(polygon[k].x(), polygon[k].y(), 0);
    const Vector3d inwards = T_camera_support.linear() * Vector3d(-edge.y(), edge.x(), 0);
    surface.corners.push_back(corner);
    surface.edges.push_back(inwards);
    surface.edge_offsets_m.push_back(-inwards.dot(corner));
  }
  return support;
}

bool may_carry(const Support& support, const std::optional<Vector3d>& up_camera) {
  if (support.plane.polygon.size() < 3) return false;
  return up_camera ? support.surface.up.dot(*up_camera) > kUpCosine : support.surface.up.dot(Vector3d(0, -1, 0)) > kSeenFromAboveCosine;
}

/// What stands in the prism over the support's outline.
Points points_above(const OrganizedCloud& cloud, const Points& rest, const Support& support, const SegmentationOptions& options) {
  Points above;
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    const Vector3d p = rest.points[i].cast<double>();
    const double height = support.surface.up.dot(p) + support.surface.camera_height_m;
    if (height <= options.plane_inlier_m || height > options.max_height_m || support.surface.inside(p) < -options.edge_margin_m) continue;
    above.add(cloud, rest.pixels[i]);
  }
  return above;
}

Points without(const OrganizedCloud& cloud, const Points& points, const std::vector<std::int32_t>& taken) {
  Points rest;
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (next < taken.size() && taken[next] == static_cast<std::int32_t>(i)) ++next;
    else rest.add(cloud, points.pixels[i]);
  }
  return rest;
}

/// The support and what stands on it; nothing where no plane carries anything.
struct Table {
  std::optional<Support> support;
  Points above;
};

Table find_table(const OrganizedCloud& cloud, const SegmentationOptions& options, const std::optional<Vector3d>& up_camera) {
  Points rest = readings(cloud, options.max_depth_m);
  Table empty;
  for (int k = 0; k < kMaxPlanes; ++k) {
    const PlaneInliers plane = ransac_plane(rest.points, options.plane_inlier_m);
    if (static_cast<int>(plane.inliers.size()) < options.min_points) break;
    Support support = make_support(rest, plane);
    rest = without(cloud, rest, plane.inliers);
    if (!may_carry(support, up_camera)) continue;
    Points above = points_above(cloud, rest, support, options);
    if (static_cast<int>(above.points.size()) >= options.min_points) return {std::move(support), std::move(above)};
    if (!empty.support) empty.support = std::move(support);  // an empty table is a result too
  }
  return empty;
}

std::string reject_reason(const std::vector<std::int32_t>& pixels, const OrganizedCloud& cloud, const FlatSurface& surface, const SegmentationOptions& options) {
  if (static_cast<int>(pixels.size()) < options.min_points) return "too_small";
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  double height = 0;
  for (const std::int32_t i : pixels) {
    const Vector3d p = cloud.point(static_cast<std::size_t>(i)).cast<double>();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    height = std::max(height, surface.up.dot(p) + surface.camera_height_m);
  }
  if ((high - low).maxCoeff() > options.max_size_m) return "too_large";
  return height < options.min_height_m ? "too_flat" : "";
}

std::vector<std::vector<std::int32_t>> masked(const OrganizedCloud& cloud, const Image<std::uint8_t>& mask) {
  std::vector<std::vector<std::int32_t>> one(1);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (mask.pixels[i] != 0 && cloud.z[i] >= kMinDepthM) one[0].push_back(static_cast<std::int32_t>(i));
  if (one[0].empty()) one.clear();
  return one;
}

/// Pixels of the objects, by their first pixel.
std::vector<std::vector<std::int32_t>> find_objects(const OrganizedCloud& cloud, const Table& table, const SegmentationOptions& options, std::vector<RejectedSegment>& rejected) {
  constexpr int kWorthNaming = 60;
  std::vector<std::vector<std::int32_t>> objects;
  if (!table.support) return objects;
  for (const auto& cluster : euclidean_clusters(table.above.points, options.cluster_tolerance_m, kWorthNaming)) {
    std::vector<std::int32_t> pixels;
    for (const std::int32_t i : cluster) pixels.push_back(table.above.pixels[static_cast<std::size_t>(i)]);
    std::string reason = reject_reason(pixels, cloud, table.support->surface, options);
    if (reason.empty() && static_cast<int>(objects.size()) >= options.max_segments) reason = "too_many";
    if (reason.empty()) objects.push_back(std::move(pixels));
    else rejected.push_back({static_cast<int>(pixels.size()), std::move(reason)});
  }
  std::sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.front() < b.front(); });
  return objects;
}

}  // namespace

Segments segment_cloud_paper(const OrganizedCloud& cloud, const SegmentationOptions& options, const std::optional<Vector3d>& up_camera, const Image<std::uint8_t>& mask) {
  Segments result;
  result.width = cloud.width;
  result.height = cloud.height;
  result.labels = Image<std::int32_t>(cloud.width, cloud.height, Segments::kUnassigned);
  if (cloud.size() == 0) return result;
  const Table table = find_table(cloud, options, up_camera);
  const bool has_mask = mask.width == cloud.width && mask.height == cloud.height && !mask.empty();
  auto objects = has_mask ? masked(cloud, mask) : find_objects(cloud, table, options, result.rejected);

  if (table.support) {
    result.planes.push_back(table.support->plane);
    for (const std::int32_t i : table.support->pixels) result.labels.pixels[static_cast<std::size_t>(i)] = Segments::kPlaneLabel;
  }
  for (std::size_t k = 0; k < objects.size(); ++k)
    for (const std::int32_t i : objects[k]) result.labels.pixels[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(k);
  std::vector<std::uint8_t> valid(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) valid[i] = cloud.valid(i) ? 1 : 0;
  const PixelRect seen = readings_rect(cloud, valid);
  for (auto& pixels : objects) {
    Segment segment;
    segment.pixels = std::move(pixels);
    segment.support = table.support ? 0 : -1;
    describe_outline(cloud, result.labels, seen, table.support ? &table.support->surface : nullptr, segment);
    result.segments.push_back(std::move(segment));
  }
  return result;
}

}  // namespace gfp
