#include "gfp/frame/frame_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace gfp {
namespace {

constexpr Nanoseconds kSecond = std::chrono::seconds(1);
constexpr int kSampledRow = 8;
constexpr int kMinNeighbours = 100;

/// Differs for pictures that differ; 8 bytes at a time.
std::uint64_t hash_of(const Image<std::uint16_t>& image) {
  std::uint64_t hash = 0x9E3779B97F4A7C15ULL;
  std::size_t i = 0;
  for (; i + 4 <= image.pixels.size(); i += 4) {
    std::uint64_t word = 0;
    std::memcpy(&word, &image.pixels[i], sizeof(word));
    hash = (hash ^ word) * 0xD1342543DE82EF95ULL;
    hash ^= hash >> 29;
  }
  for (; i < image.pixels.size(); ++i) hash = (hash ^ image.pixels[i]) * 0xD1342543DE82EF95ULL;
  return hash;
}

/// Share of horizontally neighbouring readings that differ by more than a tenth, in every 8th row; 0 where there are too few.
double roughness(const Image<std::uint16_t>& depth) {
  int neighbours = 0, rough = 0;
  for (int v = 0; v < depth.height; v += kSampledRow) {
    const std::uint16_t* const row = &depth.pixels[depth.index(0, v)];
    for (int u = 1; u < depth.width; ++u) {
      if (row[u] == 0 || row[u - 1] == 0) continue;
      ++neighbours;
      rough += 10 * std::abs(row[u] - row[u - 1]) > std::max(row[u], row[u - 1]) ? 1 : 0;
    }
  }
  return neighbours < kMinNeighbours ? 0 : static_cast<double>(rough) / neighbours;
}

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

FrameHealth::FrameHealth(const FrameHealthOptions& options, double rate_hz, bool may_repeat) : options_(options), rate_hz_(rate_hz) {
  if (may_repeat) options_.stuck_frames = 0;
}

void FrameHealth::restart() {
  recent_.clear();
  clock_.restart();
}

Result<void> FrameHealth::judge(const Frame& frame) {
  if (auto usable = judge_pixels(frame); !usable) return usable;
  const bool was_slow = fault_ == fault::kSlow;
  fault_ = {};
  host_stamp_ = clock_.to_host(frame.stamps.sensor, frame.stamps.monotonic);
  judge_times(frame.stamps);
  if (was_slow && fault_ == fault::kIntermittent) fault_ = fault::kSlow;  // the one name until it is over, not one and the other by turns
  return {};
}

Result<void> FrameHealth::refuse(std::string_view fault, std::string what) {
  fault_ = fault;
  return failure(ErrorCode::kCorruptFrame, fmt::format("{}: {}", fault, what));
}

Result<void> FrameHealth::judge_pixels(const Frame& frame) {
  const Image<std::uint16_t>& depth = frame.depth.pixels;
  if (depth.width != frame.camera.width || depth.height != frame.camera.height)
    return refuse(fault::kWrongSize, fmt::format("depth is {} x {}, expected the camera's {} x {}", depth.width, depth.height, frame.camera.width, frame.camera.height));
  if (depth.empty()) return {};
  if (std::all_of(depth.pixels.begin(), depth.pixels.end(), [](std::uint16_t value) { return value == 0; }))
    return refuse(fault::kNoReadings, fmt::format("none of {} pixels has a reading", depth.pixels.size()));
  if (const double rough = roughness(depth); rough > options_.max_rough)
    return refuse(fault::kGarbage, fmt::format("neighbours that differ by over a tenth = {:.0f} %, expected at most {:.0f} %", 100 * rough, 100 * options_.max_rough));
  if (options_.stuck_frames == 0) return {};
  const std::uint64_t hash = hash_of(depth);
  repeats_ = hash == last_hash_ ? repeats_ + 1 : 0;
  last_hash_ = hash;
  if (repeats_ >= options_.stuck_frames) return refuse(fault::kStuck, fmt::format("{} frames with the same pixels, expected fewer than {}", repeats_ + 1, options_.stuck_frames + 1));
  return {};
}

void FrameHealth::judge_times(const Stamps& stamps) {
  const Nanoseconds now = stamps.monotonic;
  recent_.push_back(now);
  while (now - recent_.front() > 2 * kSecond) recent_.pop_front();
  if (seconds(now - host_stamp_) > options_.max_delay_s) fault_ = fault::kDelayed;
  if (rate_hz_ <= 0) return;
  int gaps = 0, in_last_second = 0, gaps_in_last_second = 0;
  for (std::size_t i = 1; i < recent_.size(); ++i) {
    const bool is_gap = seconds(recent_[i] - recent_[i - 1]) * rate_hz_ > options_.max_gap_periods, is_new = now - recent_[i] < kSecond;
    gaps += is_gap ? 1 : 0;
    in_last_second += is_new ? 1 : 0;
    gaps_in_last_second += is_gap && is_new ? 1 : 0;
  }
  const bool a_second_known = now - recent_.front() > kSecond;
  const bool slow = a_second_known && in_last_second < options_.min_rate_share * rate_hz_;
  // Slow is an even trickle; with pauses between frames that come at the right pace it is intermittent.
  const bool mostly_gaps = 2 * gaps_in_last_second > in_last_second;
  if (slow && (mostly_gaps || gaps < 2)) fault_ = fault::kSlow;
  else if (gaps >= 2) fault_ = fault::kIntermittent;
}

}  // namespace gfp
