#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "gfp/frame/frame_source.hpp"
#include "gfp/frame/pacer.hpp"
#include "replay/listing.hpp"
#include "replay/load_frame.hpp"
#include "replay/replay_options.hpp"

namespace gfp {

/// Plays recorded frames as a camera would deliver them. One thread at a time.
///
/// Stamps are the recording's where every frame has one, else index / rate (30 Hz where the rate is 0); they rise strictly.
/// grab() errors: kTimeout (not due yet), kEndOfStream, and what load_frame() says of a bad file, which is then left behind:
/// the next grab() plays the next one.
class ReplaySource final : public FrameSource {
 public:
  ReplaySource(std::vector<ReplayEntry> entries, ReplayOptions options);

  SourceInfo info() const override;
  Result<void> open() override;  ///< Starts over after the end; goes on where it was after close() in the middle.
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

  std::size_t frames() const { return entries_.size(); }     ///< In one pass, after `step`.
  const FrameReport& report() const { return report_; }      ///< Of the last frame that grab() returned.

 private:
  Nanoseconds recorded_stamp(std::size_t index) const;
  Nanoseconds period() const;
  Result<LoadedFrame> load(std::size_t index);

  std::vector<ReplayEntry> entries_;
  ReplayOptions options_;
  bool stamped_ = false;            ///< Every entry has a stamp of its own.
  std::size_t position_ = 0;        ///< Next entry.
  std::uint64_t played_ = 0;        ///< Entries played or left behind since the beginning: the rhythm.
  std::uint64_t sequence_ = 0;
  Nanoseconds pass_offset_{};       ///< Added to the recorded stamps in later passes.
  Nanoseconds last_stamp_{-1};
  Pacer pacer_;
  FrameReport report_;
  std::optional<LoadedFrame> only_;  ///< The frame of a recording of one, decoded once.
};

/// Finds out what `input` is (list_replay()) and makes it a source. Files are read by grab().
/// Errors: as list_replay(), and kInvalidArgument for an option out of its bounds.
Result<std::unique_ptr<ReplaySource>> open_replay(const std::filesystem::path& input, const ReplayOptions& options = {});

}  // namespace gfp
