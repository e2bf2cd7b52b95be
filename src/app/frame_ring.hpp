#pragma once

#include <cstdint>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// Frames in memory that a driver's process writes and the daemon reads. Slots are taken in turn; each carries a version that is odd while it is written, so
/// that a reader notices what was overwritten under it. The reader trusts nothing in it. Each end: one thread at a time.
class FrameRing {
 public:
  static constexpr int kSlots = 4;
  static constexpr std::size_t kMaxPixels = std::size_t{2048} * 1536;  ///< Of depth, and of colour. Pages that no frame reaches cost nothing.

  /// An anonymous shared file of the ring's size. Errors: kIo.
  static Result<int> create();
  /// Maps it; the descriptor stays the caller's. Errors: kIo (also: not of the ring's size).
  static Result<FrameRing> map(int descriptor, bool writable);
  FrameRing(FrameRing&& other) noexcept : memory_(other.memory_) { other.memory_ = nullptr; }
  FrameRing(const FrameRing&) = delete;
  ~FrameRing();

  /// Errors: kTooLarge (more pixels than kMaxPixels).
  Result<void> write(std::uint64_t turn, const Frame& frame);
  /// The frame of that turn. Errors: kTimeout (overwritten since, the next one is newer), kCorruptFrame (no frame of ours).
  Result<Frame> read(std::uint64_t turn) const;

 private:
  explicit FrameRing(void* memory) : memory_(memory) {}
  std::byte* slot(std::uint64_t turn) const;

  void* memory_;
};

}  // namespace gfp
