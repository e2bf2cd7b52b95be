#include "synthetic/synthetic_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"
#include "gfp/primitive/families.hpp"

namespace gfp {
namespace {

constexpr double kNominalRate_hz = 30;

Result<void> in_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return failure(ErrorCode::kInvalidArgument, fmt::format("synthetic.{} = {}, expected [{}, {}]", name, value, low, high));
}

Result<void> check_classes(const std::vector<std::string>& classes) {
  const std::vector<std::string> families = family_names();
  for (const std::string& name : classes)
    if (std::find(families.begin(), families.end(), name) == families.end())
      return failure(ErrorCode::kNotFound, fmt::format("synthetic.table.classes has '{}', expected some of {}", name, fmt::join(families, ", ")));
  return {};
}

Result<void> check(const SyntheticOptions& o) {
  if (o.motion != "static" && o.motion != "orbit")
    return failure(ErrorCode::kInvalidArgument, fmt::format("synthetic.motion = {}, expected static or orbit", o.motion));
  return in_range("rate_hz", o.rate_hz, 0, 1000)
      .and_then([&] { return in_range("distance_m", o.distance_m, 0.3, 5); })
      .and_then([&] { return in_range("elevation_rad", o.elevation_rad, 0.05, std::numbers::pi / 2); })
      .and_then([&] { return in_range("orbit_period_s", o.orbit_period_s, 0.1, 3600); })
      .and_then([&] { return in_range("table.objects", o.table.objects, 0, 1000); })
      .and_then([&] { return check_classes(o.table.classes); });
}

}  // namespace

SyntheticSource::SyntheticSource(SyntheticOptions options)
    : options_(std::move(options)), scene_(table_top_scene(options_.table, options_.seed)) {}

SourceInfo SyntheticSource::info() const {
  return {"synthetic", "virtual Kinect", std::to_string(options_.seed), options_.rate_hz, 0.4, 6.5, options_.frames > 0, options_.camera.noise_scale <= 0};
}

Result<void> SyntheticSource::open() {
  pacer_.restart();
  return check(options_);
}

void SyntheticSource::close() noexcept { pacer_.restart(); }

Nanoseconds SyntheticSource::stamp(std::uint64_t sequence) const {
  const double rate_hz = options_.rate_hz > 0 ? options_.rate_hz : kNominalRate_hz;
  return Nanoseconds(std::llround(1e9 / rate_hz * static_cast<double>(sequence)));
}

Transform SyntheticSource::camera_pose(std::uint64_t sequence) const {
  double azimuth_rad = options_.azimuth_rad;
  if (options_.motion == "orbit") {
    const double turns = 1e-9 * static_cast<double>(stamp(sequence).count()) / options_.orbit_period_s;
    const double phase_rad = 2 * std::numbers::pi * (turns - std::floor(turns));
    const bool all_around = options_.orbit_swing_rad >= std::numbers::pi;
    azimuth_rad += all_around ? phase_rad : options_.orbit_swing_rad * std::sin(phase_rad);
  }
  return look_at_pose({0, 0, 0.05}, options_.distance_m, options_.elevation_rad, azimuth_rad);
}

Result<Frame> SyntheticSource::grab(std::chrono::milliseconds timeout) {
  if (options_.frames > 0 && sequence_ >= options_.frames)
    return failure(ErrorCode::kEndOfStream, fmt::format("all {} frames were delivered", options_.frames));
  if (options_.rate_hz > 0 && !pacer_.wait_until_due(stamp(sequence_), timeout))
    return failure(ErrorCode::kTimeout, fmt::format("the next frame is not due within {} ms", timeout.count()));
  const std::uint64_t noise_seed = Random(options_.seed).fork(sequence_).next();
  Frame frame = capture(scene_, default_kinect_camera(), camera_pose(sequence_), options_.camera, noise_seed).frame;
  frame.sensor = options_.sensor;
  frame.sequence = sequence_;
  frame.stamps.sensor = stamp(sequence_);
  frame.stamps.monotonic = options_.frame_time ? frame.stamps.sensor : monotonic_now();
  frame.stamps.realtime = options_.frame_time ? frame.stamps.sensor : realtime_now();
  ++sequence_;
  return frame;
}

FrameTruth SyntheticSource::truth(std::uint64_t sequence) const {
  VirtualCameraOptions perfect = options_.camera;
  perfect.noise_scale = 0;
  perfect.color = false;
  return capture(scene_, default_kinect_camera(), camera_pose(sequence), perfect, 0).truth;
}

}  // namespace gfp
