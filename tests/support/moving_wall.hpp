#pragma once

#include <cmath>

#include "gfp/frame/frame_source.hpp"

namespace gfp::test {

/// A slanted wall that differs from frame to frame, 30 a second by its stamps. `late_s`: of arrival, after the device's stamp.
inline Frame wall_frame(std::uint64_t sequence, double time_s, double late_s = 0.01) {
  Frame frame;
  frame.sequence = sequence;
  frame.camera = default_kinect_camera(64, 48);
  frame.depth.pixels = Image<std::uint16_t>(64, 48);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) frame.depth.pixels.at(u, v) = static_cast<std::uint16_t>(1000 + 2 * u + static_cast<int>((sequence + static_cast<std::uint64_t>(u * v)) % 7));
  frame.stamps.sensor = Nanoseconds(std::llround(1e9 * time_s));
  frame.stamps.monotonic = Nanoseconds(std::llround(1e9 * (time_s + late_s)));
  return frame;
}

/// Delivers it without waiting, `frames` of them.
class MovingWall final : public FrameSource {
 public:
  explicit MovingWall(std::uint64_t frames) : frames_(frames) {}
  SourceInfo info() const override { return {"wall", "fake", "1", 30, 0.4, 4, false, false}; }
  Result<void> open() override { return ++opens, Result<void>{}; }
  Result<Frame> grab(std::chrono::milliseconds) override {
    if (sequence_ >= frames_) return failure(ErrorCode::kEndOfStream, "the wall has been seen enough");
    Frame frame = wall_frame(sequence_, static_cast<double>(sequence_) / 30);
    ++sequence_;
    return frame;
  }
  void close() noexcept override {}

  int opens = 0;

 private:
  std::uint64_t frames_, sequence_ = 0;
};

}  // namespace gfp::test
