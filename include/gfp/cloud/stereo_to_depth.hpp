#pragma once

#include <cstdint>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

struct StereoOptions {
  int min_disparity_px = 0;          ///< Nothing is farther than f B / this.
  int disparities = 64;              ///< Range searched, from min_disparity_px on; rounded up to 32, 64, 96, 128, 192 or 256. Nothing is nearer than f B / its end.
  int small_step_penalty = 4;        ///< Of a disparity that differs by 1 px from its neighbour's, in census bits of 24.
  int jump_penalty = 24;             ///< Of one that differs by more.
  int min_confidence = 4;            ///< Second-best minus best path cost; below it a match is no reading.
  double max_left_right_px = 1.0;    ///< The right picture's own match must agree this well.
  int min_region_px = 80;            ///< Smaller connected regions are mismatches.
  double disparity_sigma_px = 0.2;   ///< Of a match; what depth noise is derived from.
  double max_depth_m = 6.5;          ///< Farther matches are dropped.
};

template <class Visitor>
void visit_fields(StereoOptions& o, Visitor&& field) {
  field("min_disparity_px", o.min_disparity_px, 0, 512);
  field("disparities", o.disparities, 16, 256);
  field("small_step_penalty", o.small_step_penalty, 1, 26);
  field("jump_penalty", o.jump_penalty, 2, 27);
  field("min_confidence", o.min_confidence, 0, 255);
  field("max_left_right_px", o.max_left_right_px, 0.0, 100.0);
  field("min_region_px", o.min_region_px, 0, 100'000);
  field("disparity_sigma_px", o.disparity_sigma_px, 0.01, 5.0);
  field("max_depth_m", o.max_depth_m, 0.1, 100.0);
}

/// A rectified pair: equal pinhole cameras without distortion, the right one `baseline_m` to the right.
struct RectifiedStereo {
  CameraModel camera;        ///< Of both; the left one is the frame's.
  double baseline_m = 0;
  double cx_offset_px = 0;   ///< Principal point of the left minus that of the right: the disparity of what is infinitely far.
};

inline constexpr int kDisparityUnits = 64;  ///< Of one pixel, in DisparityImage.

/// Disparity of the left picture's pixels: x_left - x_right = value / kDisparityUnits; 0 is "no match".
struct DisparityImage {
  Image<std::uint16_t> pixels;
  Image<std::uint8_t> confidence;  ///< Second-best minus best path cost where there is a match, else 0.
};

/// Matches a rectified pair: census of 24 neighbours, semi-global aggregation along five paths (Hirschmueller, PAMI 2008; left,
/// right and the three from above), the right picture's own minimum as a check, an equiangular fit for the fraction of a pixel, small regions removed.
/// Integers throughout: the same result on every machine. Errors: kInvalidArgument (empty, different sizes, options out of bounds).
/// Cost: 640 x 480 x 64 disparities about 40 ms on one core with AVX2; memory half a kilobyte a column.
Result<DisparityImage> match_stereo(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoOptions& options = {});

/// z = f B / (disparity - cx_offset), in units of 0.1 mm (of max_depth_m / 65535 where that is more); 0 where there is no match or it is too far.
DepthImage depth_of_disparity(const DisparityImage& disparity, const RectifiedStereo& stereo, const StereoOptions& options = {});

/// sigma(z) = z^2 sigma_disparity / (f B).
SensorNoise stereo_noise(const RectifiedStereo& stereo, const StereoOptions& options = {});

/// match_stereo() and depth_of_disparity() in one.
Result<DepthImage> stereo_to_depth(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const RectifiedStereo& stereo,
                                   const StereoOptions& options = {});

}  // namespace gfp
