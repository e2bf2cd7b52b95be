#pragma once

#include <cstdint>

#include "gfp/frame/frame_source.hpp"
#include "gfp/frame/pacer.hpp"
#include "gfp/simulation/virtual_scene.hpp"
#include "synthetic/synthetic_options.hpp"

namespace gfp {

/// A virtual Kinect over a procedural table-top scene: a full source that needs no hardware and no download. One thread at
/// a time, but for truth() and scene(), which are safe from any.
///
/// Frame n depends on the options and n alone, whatever the rate: noise and camera pose are functions of the sequence.
/// grab() errors: kTimeout (not due yet), kEndOfStream (after `frames`).
class SyntheticSource final : public FrameSource {
 public:
  /// Bad options are said by open().
  explicit SyntheticSource(SyntheticOptions options = {});

  SourceInfo info() const override;
  Result<void> open() override;  ///< Errors: kInvalidArgument naming the option, its value and its bound.
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

  /// The objects in their places, world frame (z up, table at z = 0).
  const VirtualScene& scene() const { return scene_; }
  /// What a perfect sensor would know of frame `sequence`: masks, depth, poses. Renders anew: about 3 ms.
  FrameTruth truth(std::uint64_t sequence) const;

 private:
  Transform camera_pose(std::uint64_t sequence) const;
  Nanoseconds stamp(std::uint64_t sequence) const;

  SyntheticOptions options_;
  VirtualScene scene_;
  std::uint64_t sequence_ = 0;
  Pacer pacer_;
};

}  // namespace gfp
