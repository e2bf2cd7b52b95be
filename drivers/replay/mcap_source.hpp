#pragma once

#include <memory>
#include <optional>

#include "gfp/frame/frame_source.hpp"
#include "gfp/frame/pacer.hpp"
#include "gfp/frame/replay_control.hpp"
#include "replay/mcap_streams.hpp"
#include "replay/replay_options.hpp"

namespace gfp {

/// Plays an MCAP recording as the camera that made it: in its own rhythm times `speed`, every `step`-th frame, from `start_s` on.
/// A control may pause it, step and seek; players of several sensors that share one keep time together. Stamps are the recorded ones and rise strictly; those of the host are the recorded ones
/// too in deterministic mode (`frame_time`), so that nothing depends on how fast it is played. One thread at a time.
/// grab() errors: kTimeout (not due yet), kPaused (held by the control, or at the end), kEndOfStream, and what McapStreams::load() says of a bad frame, which is then left behind.
class McapSource final : public FrameSource {
 public:
  McapSource(McapStreams streams, ReplayOptions options);
  ~McapSource() override { control_->leave(player_); }

  SourceInfo info() const override;
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override { pacer_.restart(); }

  std::size_t frames() const { return streams_.frames(); }
  const FrameReport& report() const { return report_; }
  ReplayControl& control() { return *control_; }

 private:
  void follow_control();
  std::size_t first_at(Nanoseconds recorded_at) const;
  Nanoseconds start() const;
  Nanoseconds due(Nanoseconds recorded_at) const;
  void keep_time_from(Nanoseconds recorded_at);

  McapStreams streams_;
  const ReplayOptions options_;
  const std::shared_ptr<ReplayControl> control_;
  const ReplayControl::Player player_;
  Pacer pacer_;
  double speed_ = 1;              ///< That the pacer counts with.
  std::size_t position_;          ///< Next frame.
  std::uint64_t sequence_ = 0;
  Nanoseconds last_played_{};     ///< Recorded time of the last frame.
  Nanoseconds pass_offset_{};     ///< Added to the stamps of later passes...
  Nanoseconds seek_offset_{};     ///< ...and after a seek.
  Nanoseconds last_stamp_{-1};
  FrameReport report_;
};

/// Errors: as McapStreams::open(), and kInvalidArgument for an option out of its bounds.
Result<std::unique_ptr<McapSource>> open_mcap(const std::filesystem::path& file, const ReplayOptions& options = {});

}  // namespace gfp
