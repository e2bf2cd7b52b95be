#include "gfp/segmentation/segment_cloud.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "segmentation/assemble.hpp"
#include "segmentation/components.hpp"
#include "segmentation/enclosed.hpp"
#include "segmentation/outline.hpp"
#include "segmentation/pixel_classes.hpp"
#include "segmentation/reach_down.hpp"
#include "segmentation/supports.hpp"

namespace gfp {
namespace {

constexpr double kWorkspaceDepth = 2.0;  // metres: beyond it the noise of a triangulating sensor is a centimetre and more
constexpr double kClearOfBand = 1.1;    // a rough or distant support has bumps that reach over its band
constexpr int kWorthNaming = 60;  // pixels: fewer are noise that nobody wants to read about

struct Candidate {
  PixelList pixels;
  int support = -1;
};

// Where the points lie, in the support's frame (camera frame where there is none).
Eigen::Vector3d extents(const OrganizedCloud& cloud, const PixelList& pixels, const Transform& T_frame_camera) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (std::size_t k = 0; k < pixels.size(); k += pixels.size() / 4000 + 1) {
    const Eigen::Vector3d p = T_frame_camera * cloud.point(static_cast<std::size_t>(pixels[k])).cast<double>();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return high - low;
}

bool cut_by_image(const OrganizedCloud& cloud, const PixelRect& readings, const PixelList& pixels) {
  return 3 <= std::count_if(pixels.begin(), pixels.end(), [&](std::int32_t i) { return at_border(readings, i % cloud.width, i / cloud.width); });
}

// Empty: an object. Else the reason why not.
std::string reject_reason(const OrganizedCloud& cloud, const Supports& supports, const SegmentationOptions& options, const PixelRect& readings, const Candidate& candidate) {
  if (static_cast<int>(candidate.pixels.size()) < options.min_points) return "too_small";
  const FlatSurface* support = candidate.support < 0 ? nullptr : &supports.surfaces[static_cast<std::size_t>(candidate.support)];
  const Transform T_support_camera = support == nullptr ? Transform::Identity() : supports.planes[static_cast<std::size_t>(candidate.support)].T_camera_support.inverse();
  const Eigen::Vector3d size = extents(cloud, candidate.pixels, T_support_camera);
  if (size.maxCoeff() > options.max_size_m) return "too_large";
  // What the image cuts goes on outside: half of the greatest size is as much as may be seen of it.
  if (size.maxCoeff() > 0.5 * options.max_size_m && cut_by_image(cloud, readings, candidate.pixels)) return "too_large";
  if (support == nullptr) return {};

  std::vector<float> heights;
  int outside = 0, far = 0;
  for (std::size_t k = 0; k < candidate.pixels.size(); k += candidate.pixels.size() / 1000 + 1) {
    const std::int32_t i = candidate.pixels[k];
    heights.push_back(static_cast<float>(support->height(cloud, i)));
    far += static_cast<double>(cloud.z[static_cast<std::size_t>(i)]) > kWorkspaceDepth;
    outside += support->inside(cloud.point(static_cast<std::size_t>(i)).cast<double>()) < 0;
  }
  const auto nth = heights.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), nth, heights.end());
  const double z = static_cast<double>(cloud.z[static_cast<std::size_t>(candidate.pixels[candidate.pixels.size() / 2])]);
  if (*nth < std::max(options.min_height_m, kClearOfBand * support->band(z))) return "too_flat";
  if (2 * std::max(outside, far) > static_cast<int>(heights.size())) return "outside_workspace";
  return {};
}

// The supports in the order of the result: the one that carries most pixels of objects first, then by size.
std::vector<int> support_order(const Supports& supports, const std::vector<Candidate>& taken) {
  std::vector<std::size_t> carried(supports.planes.size(), 0);
  for (const Candidate& candidate : taken)
    if (candidate.support >= 0) carried[static_cast<std::size_t>(candidate.support)] += candidate.pixels.size();
  std::vector<int> order(supports.planes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    return carried[i] != carried[j] ? carried[i] > carried[j] : supports.planes[i].inliers > supports.planes[j].inliers;
  });
  return order;
}

void label_pixels(const std::vector<std::uint8_t>& classes, const std::vector<int>& rank, const std::vector<Candidate>& taken, Image<std::int32_t>& labels) {
  std::array<std::int32_t, 256> label_of;
  label_of.fill(Segments::kUnassigned);
  labels.pixels.reserve(classes.size());
  for (std::size_t k = 0; k < rank.size(); ++k) label_of[kOnSupport + k] = Segments::kPlaneLabel - rank[k];
  for (auto run = classes.begin(); run != classes.end();) {  // by runs of one class: they are long
    const auto end = std::find_if(run + 1, classes.end(), [c = *run](std::uint8_t other) { return other != c; });
    labels.pixels.insert(labels.pixels.end(), static_cast<std::size_t>(end - run), label_of[*run]);
    run = end;
  }
  for (std::size_t k = 0; k < taken.size(); ++k)
    for (const auto i : taken[k].pixels) labels.pixels[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(k);
}

// The user's own mask: its readings are the one segment.
PixelList masked_pixels(const std::vector<std::uint8_t>& valid, const Image<std::uint8_t>& mask) {
  PixelList pixels;
  for (std::size_t i = 0; i < valid.size(); ++i)
    if (valid[i] != 0 && mask.pixels[i] != 0) pixels.push_back(static_cast<std::int32_t>(i));
  return pixels;
}

// The support that the pixels stand on: the highest one that is below (almost) all of them, and under most of them.
int support_of(const OrganizedCloud& cloud, const Supports& supports, const PixelList& pixels) {
  if (supports.surfaces.size() == 1) return 0;
  int best = -1;
  double best_base = std::numeric_limits<double>::infinity();
  const std::size_t step = std::max<std::size_t>(1, pixels.size() / 500);
  for (std::size_t k = 0; k < supports.surfaces.size(); ++k) {
    const FlatSurface& surface = supports.surfaces[k];
    std::vector<double> heights;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < pixels.size(); i += step) {
      heights.push_back(surface.height(cloud, pixels[i]));
      inside += surface.inside(cloud.point(static_cast<std::size_t>(pixels[i])).cast<double>()) >= 0;
    }
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    const double base = *low < -0.01 || 2 * inside < heights.size() ? 10.0 + std::abs(*low) : *low;  // a poor one only if there is no other
    if (base < best_base) {
      best_base = base;
      best = static_cast<int>(k);
    }
  }
  return best;
}

// Clusters are cut where surfaces end and put together again by what makes an object.
std::vector<Candidate> objects_of(const OrganizedCloud& cloud, const SegmentationOptions& options, const std::vector<std::uint8_t>& valid,
                                  const Supports& supports, const std::vector<PixelList>& clusters) {
  std::vector<int> support;
  for (const PixelList& cluster : clusters) support.push_back(support_of(cloud, supports, cluster));
  const PieceMap map = cut_into_pieces(cloud, clusters, options.cluster_tolerance_m);
  const Eigen::Vector3d up = supports.surfaces.empty() ? Eigen::Vector3d(0, -1, 0) : supports.surfaces.front().up;
  const auto contacts = find_contacts(cloud, map, valid, options.cluster_tolerance_m, up);
  std::vector<const FlatSurface*> surfaces;
  for (const int cluster : map.cluster) {
    const int s = support[static_cast<std::size_t>(cluster)];
    surfaces.push_back(s < 0 ? nullptr : &supports.surfaces[static_cast<std::size_t>(s)]);
  }
  const auto object = assemble(cloud, map, valid, contacts, surfaces, up, options);
  std::vector<Candidate> candidates(object.empty() ? 0 : static_cast<std::size_t>(*std::max_element(object.begin(), object.end())) + 1);
  for (std::size_t p = 0; p < object.size(); ++p) {
    PixelList& pixels = candidates[static_cast<std::size_t>(object[p])].pixels;
    const auto middle = static_cast<std::ptrdiff_t>(pixels.size());
    pixels.insert(pixels.end(), map.pixels[p].begin(), map.pixels[p].end());
    std::inplace_merge(pixels.begin(), pixels.begin() + middle, pixels.end());
  }
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    Candidate& candidate = candidates[k];
    candidate.support = support_of(cloud, supports, candidate.pixels);
    if (candidate.support >= 0 && static_cast<int>(candidate.pixels.size()) >= options.min_points)
      take_enclosed(cloud, valid, supports.surfaces[static_cast<std::size_t>(candidate.support)], candidate.pixels);
  });
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.pixels.front() < b.pixels.front(); });
  return candidates;
}

std::vector<Candidate> clusters(const OrganizedCloud& cloud, const SegmentationOptions& options, const std::vector<std::uint8_t>& classes,
                                const Supports& supports) {
  const std::uint8_t lowest = supports.planes.empty() ? kElsewhere : kAbove, highest = supports.planes.empty() ? kElsewhere : 255;
  std::vector<std::uint8_t> free(classes.size());
  std::transform(classes.begin(), classes.end(), free.begin(), [&](std::uint8_t c) { return static_cast<std::uint8_t>((c >= lowest) & (c <= highest)); });
  return objects_of(cloud, options, classes, supports,
                    connected_components(depth_grid(cloud), free, classes, {options.cluster_tolerance_m, options.cluster_tolerance_m}, kWorthNaming));
}

void keep_largest(int count, std::vector<Candidate>& candidates, std::vector<RejectedSegment>& rejected) {
  if (static_cast<int>(candidates.size()) <= count) return;
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.pixels.size() > b.pixels.size(); });
  for (std::size_t k = static_cast<std::size_t>(count); k < candidates.size(); ++k) rejected.push_back({static_cast<int>(candidates[k].pixels.size()), "too_many"});
  candidates.resize(static_cast<std::size_t>(count));
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.pixels.front() < b.pixels.front(); });
}

}  // namespace

Segments segment_cloud(const OrganizedCloud& cloud, const SegmentationOptions& options, const std::optional<Eigen::Vector3d>& up_camera,
                       const SupportPlane* last, const Image<std::uint8_t>& mask) {
  Segments result;
  result.width = cloud.width;
  result.height = cloud.height;
  result.labels.width = cloud.width;
  result.labels.height = cloud.height;
  if (cloud.size() == 0) return result;

  const Supports supports = find_supports(cloud, options, up_camera, last);
  auto classes = classify_pixels(cloud, supports, options);
  reach_down(cloud, supports, classes);

  const PixelRect readings = readings_rect(cloud, classes);
  std::vector<Candidate> taken;
  if (mask.width == cloud.width && mask.height == cloud.height && !mask.empty()) {
    taken.push_back({masked_pixels(classes, mask), -1});
    if (taken.front().pixels.empty()) taken.clear();
    else taken.front().support = support_of(cloud, supports, taken.front().pixels);
  } else {
    std::vector<Candidate> candidates = clusters(cloud, options, classes, supports);
    std::vector<std::string> reasons(candidates.size());
    oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(),
                              [&](std::size_t k) { reasons[k] = reject_reason(cloud, supports, options, readings, candidates[k]); });
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (reasons[k].empty()) taken.push_back(std::move(candidates[k]));
      else result.rejected.push_back({static_cast<int>(candidates[k].pixels.size()), std::move(reasons[k])});
    }
    keep_largest(options.max_segments, taken, result.rejected);
  }

  const std::vector<int> order = support_order(supports, taken);
  std::vector<int> rank(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[static_cast<std::size_t>(order[r])] = static_cast<int>(r);
    result.planes.push_back(supports.planes[static_cast<std::size_t>(order[r])]);
  }
  label_pixels(classes, rank, taken, result.labels);
  result.segments.resize(taken.size());
  oneapi::tbb::parallel_for(std::size_t{0}, taken.size(), [&](std::size_t k) {
    Segment& segment = result.segments[k];
    segment.pixels = std::move(taken[k].pixels);
    const bool supported = taken[k].support >= 0;
    if (supported) segment.support = rank[static_cast<std::size_t>(taken[k].support)];
    describe_outline(cloud, result.labels, readings, supported ? &supports.surfaces[static_cast<std::size_t>(taken[k].support)] : nullptr, segment);
  });
  return result;
}

}  // namespace gfp
