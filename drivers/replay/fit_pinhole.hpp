#pragma once

#include <optional>
#include <string_view>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/error.hpp"
#include "replay/axes.hpp"
#include "replay/pcd.hpp"

namespace gfp {

/// The camera that an organised cloud was taken with, found from the cloud itself.
struct PinholeFit {
  CameraModel camera;
  Axes axes;          ///< Which file axes are right, down and forward.
  double rms_px = 0;  ///< Distance of the points' projections from their pixels.
  int points = 0;     ///< Readings used.
};

/// Fits u = cx + fx right/forward and v = cy + fy down/forward to all readings, over every assignment of the file's axes
/// (or the given one) whose forward coordinate is positive. Right and down are where columns and rows grow, so axes and
/// focal lengths have their signs. NaN, infinity and forward = 0 are no readings.
/// Errors: kTooFewPoints (fewer than 100 readings), kUnsupported (no assignment projects the points within kMaxPinholeRms_px
/// of their pixels: not a pinhole camera's grid, or not with these axes). Cost: about 10 ms at 640 x 480.
Result<PinholeFit> fit_pinhole(const PcdCloud& cloud, const std::optional<Axes>& axes, std::string_view name);

inline constexpr double kMaxPinholeRms_px = 0.5;

}  // namespace gfp
