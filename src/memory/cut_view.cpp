#include "memory/cut_view.hpp"

#include <algorithm>
#include <cstddef>

namespace gfp {
namespace {

PixelRect with_margin(const PixelRect& box, int width, int height, const AssociateOptions& options) {
  const int margin = std::max(options.min_margin_px, static_cast<int>(options.margin * std::max(box.width(), box.height())));
  return {std::max(0, box.u0 - margin), std::max(0, box.v0 - margin), std::min(width, box.u1 + margin), std::min(height, box.v1 + margin)};
}

/// Depth beyond which a reading belongs to what is behind the object: its farthest point.
float far_end(const Segment& segment, const OrganizedCloud& cloud) {
  float far_m = 0;
  for (const std::int32_t pixel : segment.pixels) {
    const float z = cloud.z[static_cast<std::size_t>(pixel)];
    if (z > far_m) far_m = z;  // false for NaN
  }
  return far_m;
}

struct EvidenceRule {
  std::int32_t segment, support_label;
  float far_m;

  Evidence operator()(std::int32_t label, float z) const {
    if (!(z > 0)) return Evidence::kUnknown;
    if (label == segment) return Evidence::kObject;
    if (label == support_label) return Evidence::kSupport;
    if (label >= 0) return Evidence::kOther;
    return z > far_m ? Evidence::kBackground : Evidence::kOther;  // what nobody claimed may be a part of ours, or before it
  }
};

void fill_tile(ObjectView& view, const Segments& segments, const OrganizedCloud& cloud, const NormalMap& normals) {
  const Segment& segment = segments.segments[static_cast<std::size_t>(view.segment)];
  const std::int32_t support_label = segment.support >= 0 ? Segments::kPlaneLabel - segment.support : Segments::kUnassigned - 1;
  const EvidenceRule rule{view.segment, support_label, far_end(segment, cloud)};
  view.depth_m = Image<float>(view.tile.width(), view.tile.height(), 0.0F);
  view.evidence = Image<Evidence>(view.tile.width(), view.tile.height(), Evidence::kUnknown);
  view.normals = Image<Eigen::Vector3f>(view.tile.width(), view.tile.height(), Eigen::Vector3f::Zero());
  std::size_t cell = 0;
  for (int v = view.tile.v0; v < view.tile.v1; ++v) {
    for (int u = view.tile.u0; u < view.tile.u1; ++u, ++cell) {
      const std::size_t pixel = segments.labels.index(u, v);
      if (!cloud.valid(pixel)) continue;
      view.depth_m.pixels[cell] = cloud.z[pixel];
      const Evidence evidence = rule(segments.labels.pixels[pixel], cloud.z[pixel]);
      view.evidence.pixels[cell] = evidence;
      if (evidence != Evidence::kObject) continue;
      ++view.object_pixels;
      if (!normals.z.empty() && normals.valid(pixel)) view.normals.pixels[cell] = normals.normal(pixel);
    }
  }
}

/// A frame with z along `up`, its origin below the seen points' mean at their lowest one.
void guess_support(ObjectView& view, const Segment& segment, const OrganizedCloud& cloud, const Eigen::Vector3d& up) {
  const auto [x_axis, y_axis] = orthonormal_basis(up);
  std::vector<double> heights;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::int32_t index : segment.pixels) {
    const auto pixel = static_cast<std::size_t>(index);
    if (!cloud.valid(pixel)) continue;
    const Eigen::Vector3d point = cloud.point(pixel).cast<double>();
    sum += point;
    heights.push_back(up.dot(point));
  }
  view.T_camera_support.linear() << x_axis, y_axis, up;
  if (heights.empty()) return;
  const Eigen::Vector3d mean = sum / static_cast<double>(heights.size());
  std::sort(heights.begin(), heights.end());
  const double lowest = heights.front();
  const double highest = heights[static_cast<std::size_t>(0.995 * static_cast<double>(heights.size() - 1))];
  view.T_camera_support.translation() = mean + (lowest - up.dot(mean)) * up;
  view.height_m = highest - lowest;
}

}  // namespace

ObjectView cut_view(const Segments& segments, int index, const OrganizedCloud& cloud, const NormalMap& normals,
                    const Frame& frame, const Eigen::Vector3d& up_camera, const AssociateOptions& options) {
  const Segment& segment = segments.segments[static_cast<std::size_t>(index)];
  ObjectView view;
  view.segment = index;
  view.camera = cloud.camera;
  view.noise = frame.noise;
  view.tile = with_margin(segment.bbox, segments.width, segments.height, options);
  view.touches_border = segment.touches_border;
  view.occluded = segment.occluded;
  view.top_cut = segment.top_cut;
  view.height_m = segment.height_m;
  view.has_support = segment.support >= 0;
  if (view.has_support) {
    view.T_camera_support = segments.planes[static_cast<std::size_t>(segment.support)].T_camera_support;
  } else {
    guess_support(view, segment, cloud, up_camera);
  }
  fill_tile(view, segments, cloud, normals);
  return view;
}

}  // namespace gfp
