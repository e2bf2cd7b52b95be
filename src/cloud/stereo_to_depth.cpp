#include "gfp/cloud/stereo_to_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "cloud/refine_disparity.hpp"
#include "cloud/remove_small_regions.hpp"
#include "cloud/stereo_kernels.hpp"

namespace gfp {
namespace {

using Bytes = std::vector<std::uint8_t>;

Result<void> in_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return failure(ErrorCode::kInvalidArgument, std::string("stereo.") + name + " = " + std::to_string(value) + ", expected [" + std::to_string(low) + ", " + std::to_string(high) + "]");
}

Result<void> check(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoOptions& o) {
  if (left.empty() || left.width != right.width || left.height != right.height)
    return failure(ErrorCode::kInvalidArgument, "stereo pair: left is " + std::to_string(left.width) + " x " + std::to_string(left.height) + ", right " + std::to_string(right.width) + " x " +
                                                    std::to_string(right.height) + ", expected equal sizes above 0");
  return in_range("min_disparity_px", o.min_disparity_px, 0, 512)
      .and_then([&] { return in_range("disparities", o.disparities, 16, 256); })
      .and_then([&] { return in_range("jump_penalty", o.jump_penalty, 2, 255 / kPaths - kCensusBits); })  // the sum of the paths fits a byte
      .and_then([&] { return in_range("small_step_penalty", o.small_step_penalty, 1, o.jump_penalty); });
}

/// The next of the ranges that the kernels are made for.
int searched_disparities(const StereoOptions& options) {
  for (const int range : {32, 64, 96, 128, 192})
    if (options.disparities <= range) return range;
  return 256;
}

/// The picture with its border pixels repeated around it; or its mirror image.
struct Padded {
  std::ptrdiff_t stride;
  Bytes pixels;
  explicit Padded(const Image<std::uint8_t>& image, bool is_mirrored) : stride(image.width + 2 * kCensusMargin), pixels(static_cast<std::size_t>(stride * (image.height + 2 * kCensusMargin))) {
    for (int v = -kCensusMargin; v < image.height + kCensusMargin; ++v) {
      const std::uint8_t* const from = &image.pixels[image.index(0, std::clamp(v, 0, image.height - 1))];
      std::uint8_t* const to = pixels.data() + (v + kCensusMargin) * stride;
      std::memset(to, from[0], kCensusMargin);
      std::memcpy(to + kCensusMargin, from, static_cast<std::size_t>(image.width));
      std::memset(to + kCensusMargin + image.width, from[image.width - 1], kCensusMargin);
      if (is_mirrored) std::reverse(to, to + stride);
    }
  }
  const std::uint8_t* row(int v) const { return pixels.data() + (v + kCensusMargin) * stride + kCensusMargin; }
};

/// The buffers of one image's aggregation, and the row that uses them.
class Aggregation {
 public:
  Aggregation(int width, const StereoOptions& options) : slot_(searched_disparities(options) + kPathGuard) {
    row_.width = width;
    row_.disparities = slot_ - kPathGuard;
    row_.small_step = static_cast<std::uint8_t>(options.small_step_penalty);
    row_.jump = static_cast<std::uint8_t>(options.jump_penalty);
    row_.first_invalid = width - options.min_disparity_px;
    for (std::size_t p = 0; p < 3; ++p) {
      left_[p].resize(static_cast<std::size_t>(width));
      right_[p].resize(static_cast<std::size_t>(width + options.min_disparity_px + row_.disparities));
      row_.left[p] = left_[p].data();
      row_.right[p] = right_[p].data() + options.min_disparity_px;
    }
    for (Bytes& path : paths_) path = guarded(width + 2);
    row_.cost = slots(0), row_.sum = slots(1), row_.up = slots(2), row_.up_right = slots(3);
    for (Bytes& values : found_) values.resize(static_cast<std::size_t>(width));
    row_.best = found_[0].data(), row_.best_sum = found_[1].data(), row_.second_sum = found_[2].data();
    row_.sum_before = found_[3].data(), row_.sum_after = found_[4].data(), row_.right_best = found_[5].data();
  }

  const StereoRow& run(const Padded& left, const Padded& right, int v) {
    kernels_.census_row(left.row(v), left.stride, 1, row_.width, left_[0].data(), left_[1].data(), left_[2].data());
    kernels_.census_row(right.row(v), right.stride, -1, row_.width, right_[0].data(), right_[1].data(), right_[2].data());
    row_.up_left_before = slots(4 + v % 2), row_.up_left = slots(5 - v % 2);
    kernels_.aggregate_row(row_);
    return row_;
  }

 private:
  Bytes guarded(int slots) const {
    Bytes bytes(static_cast<std::size_t>(kPathGuard + slots * slot_), 0);
    for (int end = kPathGuard; end <= kPathGuard + slots * slot_; end += slot_) std::fill_n(bytes.data() + end - kPathGuard, kPathGuard, kGuardValue);
    return bytes;
  }
  /// Slot 0 of a path's row: behind the first guard and slot -1.
  std::uint8_t* slots(int path) { return paths_[static_cast<std::size_t>(path)].data() + kPathGuard + slot_; }

  const StereoKernels& kernels_ = has_avx2_stereo_kernels() ? kAvx2StereoKernels : kAnyStereoKernels;
  int slot_;
  std::array<Bytes, 3> left_, right_;
  std::array<Bytes, 6> paths_, found_;
  StereoRow row_;
};

/// Which pixels' matches the right picture confirms: those that it matches about the same way. The only look-up: what follows takes many pixels at a time.
void confirm(const StereoRow& given, int max_difference, std::uint8_t* is_confirmed) {
  const StereoRow row = given;  // a local: the bytes that are stored below cannot change it
  for (int x = 0; x < row.width; ++x) {
    const int d = row.best[x], met = row.width - 1 - x + d;
    is_confirmed[x] = met < row.first_invalid && std::abs(row.right_best[met] - d) <= max_difference ? 1 : 0;
  }
}

/// The matches of one row that pass the checks. Between whole disparities: where two lines of equal and opposite slope through three sums meet. Lines,
/// since census costs grow linearly with the error: a parabola errs half again as much.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void take_matches(const StereoRow& given, const StereoOptions& options, const std::uint8_t* is_confirmed, std::uint16_t* __restrict disparity, std::uint8_t* __restrict confidence) {
  constexpr float kMost = 0.5F * kDisparityUnits - 1;  // below half a pixel: rounding gives the middle back
  const StereoRow row = given;
  const int min_disparity = options.min_disparity_px, min_confidence = options.min_confidence;
  for (int x = 0; x < row.width; ++x) {
    const int d = row.best[x], before = row.sum_before[x], after = row.sum_after[x], second = row.second_sum[x] - row.best_sum[x];
    const int height = (before > after ? before : after) - row.best_sum[x];
    const bool has_slopes = (d > 0) & (d + 1 < row.disparities) & (height > 0), holds = (is_confirmed[x] != 0) & (second >= min_confidence);
    float units = static_cast<float>((before - after) * (kDisparityUnits / 2)) / static_cast<float>(has_slopes ? height : 1);
    units = units > kMost ? kMost : units;
    units = units < -kMost ? -kMost : units;
    const int found = kDisparityUnits * (d + min_disparity) + (has_slopes ? static_cast<int>(units) : 0);
    disparity[x] = static_cast<std::uint16_t>(holds ? found : 0);
    confidence[x] = static_cast<std::uint8_t>(holds ? second : 0);
  }
}

}  // namespace

Result<DisparityImage> match_stereo(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoOptions& options) {
  if (const auto valid = check(left, right, options); !valid) return tl::unexpected<Error>(valid.error());
  const Padded padded_left(left, false), padded_right(right, true);
  Aggregation aggregation(left.width, options);
  Bytes is_confirmed(static_cast<std::size_t>(left.width));
  DisparityImage found{Image<std::uint16_t>(left.width, left.height), Image<std::uint8_t>(left.width, left.height)};
  for (int v = 0; v < left.height; ++v) {
    const StereoRow& row = aggregation.run(padded_left, padded_right, v);
    const std::size_t at = found.pixels.index(0, v);
    confirm(row, static_cast<int>(options.max_left_right_px), is_confirmed.data());
    take_matches(row, options, is_confirmed.data(), &found.pixels.pixels[at], &found.confidence.pixels[at]);
  }
  refine_disparity(left, right, found);
  remove_small_regions(found.pixels, kDisparityUnits, options.min_region_px);
  std::transform(found.pixels.pixels.begin(), found.pixels.pixels.end(), found.confidence.pixels.begin(), found.confidence.pixels.begin(),
                 [](std::uint16_t disparity, std::uint8_t confidence) { return disparity == 0 ? std::uint8_t{0} : confidence; });
  return found;
}

DepthImage depth_of_disparity(const DisparityImage& disparity, const RectifiedStereo& stereo, const StereoOptions& options) {
  DepthImage depth{Image<std::uint16_t>(disparity.pixels.width, disparity.pixels.height), std::max(1e-4, options.max_depth_m / 65535)};
  const double focal_baseline = stereo.camera.fx * stereo.baseline_m;
  // A table, since there are few disparities: 0 for those that are at infinity or too far.
  std::vector<std::uint16_t> units(65536, 0);
  for (std::size_t d = 1; d < units.size(); ++d) {
    const double z = focal_baseline / (static_cast<double>(d) / kDisparityUnits - stereo.cx_offset_px);
    if (z > 0 && z <= options.max_depth_m) units[d] = static_cast<std::uint16_t>(std::lround(z / depth.scale_m));
  }
  std::transform(disparity.pixels.pixels.begin(), disparity.pixels.pixels.end(), depth.pixels.pixels.begin(), [&](std::uint16_t d) { return units[d]; });
  return depth;
}

SensorNoise stereo_noise(const RectifiedStereo& stereo, const StereoOptions& options) {
  return {0, options.disparity_sigma_px / (stereo.camera.fx * stereo.baseline_m), 0};
}

Result<DepthImage> stereo_to_depth(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const RectifiedStereo& stereo, const StereoOptions& options) {
  return match_stereo(left, right, options).map([&](const DisparityImage& disparity) { return depth_of_disparity(disparity, stereo, options); });
}

}  // namespace gfp
