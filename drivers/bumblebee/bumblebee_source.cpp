#include "bumblebee/bumblebee_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <utility>

#include "bumblebee/aravis_camera.hpp"
#ifdef GFP_HAS_DC1394
#include "bumblebee/firewire_camera.hpp"
#endif
#include "gfp/frame/session_clock.hpp"

namespace gfp {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(2);            // while a pair is matched and there is room for another
constexpr Nanoseconds kPairPatience = std::chrono::milliseconds(100);  // for the other eye of a picture that is here

/// The threads: Aravis' own receives packets; grab()'s takes whole transfers and starts, for each, one that decodes and matches it.
class BumblebeeSource final : public FrameSource {
 public:
  BumblebeeSource(BumblebeeOptions options, StereoToFrame to_frame) : options_(std::move(options)), to_frame_(std::move(to_frame)) {}
  ~BumblebeeSource() override { close(); }

  SourceInfo info() const override { return {"bumblebee", "stereo camera", options_.device, options_.rate_hz, 0.2, 20.0, false, false}; }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override { matching_.clear(), left_.reset(), right_.reset(); }

 private:
  /// What belongs to one frame: one transfer, or one of each eye.
  struct Capture {
    Transfer left, right;
  };
  Result<std::unique_ptr<CameraLink>> open_link(const std::string& device) const;
  Result<Capture> capture(std::chrono::milliseconds timeout);
  Result<Capture> pair_of_two(Transfer left, Nanoseconds deadline);
  Frame stamped(const Transfer& transfer);
  Result<StereoPair> decode(const Capture& capture) const;
  Result<Frame> match(const Capture& capture, Frame frame) const;

  const BumblebeeOptions options_;
  const StereoToFrame to_frame_;
  std::unique_ptr<CameraLink> left_, right_;        ///< The right one of two devices only.
  std::deque<std::future<Result<Frame>>> matching_; ///< In the order of the pictures.
  SessionClock clock_;
  std::uint64_t first_of_session_ = 0, sequence_ = 0;
};

Result<std::unique_ptr<CameraLink>> BumblebeeSource::open_link(const std::string& device) const {
  const auto as_link = [](auto camera) -> std::unique_ptr<CameraLink> { return camera; };
  if (options_.transport == "aravis") return AravisCamera::open(device, options_).map(as_link);
#ifdef GFP_HAS_DC1394
  return FirewireCamera::open(device, options_).map(as_link);
#else
  return failure(ErrorCode::kUnsupported, "bumblebee.transport = firewire, which this build has not (it needs libdc1394-dev)");
#endif
}

Result<void> BumblebeeSource::open() {
  close();
  const std::size_t comma = options_.device.find(',');
  const bool two = options_.layout == "two_devices";
  if (two && (comma == 0 || comma == std::string::npos || comma + 1 == options_.device.size()))
    return failure(ErrorCode::kInvalidArgument, fmt::format("bumblebee: input = {}, expected LEFT,RIGHT for layout two_devices", options_.device));
  auto left = open_link(two ? options_.device.substr(0, comma) : options_.device);
  if (!left) return tl::unexpected<Error>(left.error());
  left_ = std::move(*left);
  if (two) {
    auto right = open_link(options_.device.substr(comma + 1));
    if (!right) return close(), tl::unexpected<Error>(right.error());
    right_ = std::move(*right);
  }
  clock_.restart();
  first_of_session_ = sequence_;
  return {};
}

Result<Frame> BumblebeeSource::grab(std::chrono::milliseconds timeout) {
  if (left_ == nullptr) return failure(ErrorCode::kDeviceLost, "the stereo camera is not open");
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const auto left_ms = [&] { return std::chrono::duration_cast<std::chrono::milliseconds>(std::max(deadline - std::chrono::steady_clock::now(), std::chrono::steady_clock::duration::zero())); };
  while (true) {
    const bool is_full = static_cast<int>(matching_.size()) >= options_.threads;
    if (!matching_.empty() && matching_.front().wait_for(is_full ? left_ms() : std::chrono::milliseconds(0)) == std::future_status::ready) {
      auto done = std::move(matching_.front());
      matching_.pop_front();
      return done.get();
    }
    if (left_ms() == std::chrono::milliseconds::zero() && !matching_.empty()) return failure(ErrorCode::kTimeout, fmt::format("no frame within {} ms", timeout.count()));
    auto next = capture(matching_.empty() ? left_ms() : std::min(left_ms(), kPoll));
    if (!next && next.error().code == ErrorCode::kTimeout && !matching_.empty()) continue;
    if (!next) return tl::unexpected<Error>(next.error());
    Frame frame = stamped(next->left);
    matching_.push_back(std::async(std::launch::async, [this, taken = std::move(*next), frame = std::move(frame)]() mutable { return match(taken, std::move(frame)); }));
  }
}

Frame BumblebeeSource::stamped(const Transfer& transfer) {
  Frame frame;
  frame.sensor = options_.sensor;
  frame.sequence = first_of_session_ + transfer.number;  // with gaps, where pictures were lost or left out
  sequence_ = frame.sequence + 1;
  frame.stamps = {clock_.stamp(transfer.device), transfer.arrival, realtime_now() - (monotonic_now() - transfer.arrival)};
  return frame;
}

Result<Frame> BumblebeeSource::match(const Capture& capture, Frame frame) const {
  auto pair = decode(capture);
  if (!pair) return tl::unexpected<Error>(pair.error());
  take_off_mosaic(*pair, options_.bayer, options_.color);
  return to_frame_(*pair, frame).map([&] { return std::move(frame); });
}

Result<StereoPair> BumblebeeSource::decode(const Capture& capture) const {
  if (options_.layout == "interleaved") return decode_interleaved(capture.left.picture(), options_.first_byte, options_.eyes);
  if (options_.layout == "stacked") return decode_stacked(capture.left.picture());
  auto left = decode_single(capture.left.picture()), right = decode_single(capture.right.picture());
  if (!left) return tl::unexpected<Error>(left.error());
  if (!right) return tl::unexpected<Error>(right.error());
  return StereoPair{std::move(*left), std::move(*right), {}};
}

Result<BumblebeeSource::Capture> BumblebeeSource::capture(std::chrono::milliseconds timeout) {
  const Nanoseconds deadline = monotonic_now() + timeout;
  auto left = left_->next(timeout);
  if (!left) return tl::unexpected<Error>(left.error());
  if (right_ == nullptr) return Capture{std::move(*left), {}};
  return pair_of_two(std::move(*left), std::max(deadline, monotonic_now() + kPairPatience));
}

/// The eyes arrive apart: the older one is left out until both are of one instant.
Result<BumblebeeSource::Capture> BumblebeeSource::pair_of_two(Transfer left, Nanoseconds deadline) {
  const auto left_ms = [&] { return std::chrono::duration_cast<std::chrono::milliseconds>(std::max(Nanoseconds::zero(), deadline - monotonic_now())); };
  auto right = right_->next(left_ms());
  while (true) {
    if (!right) return tl::unexpected<Error>(right.error());
    const double apart_s = std::chrono::duration<double>(left.arrival - right->arrival).count();
    if (std::abs(apart_s) <= options_.pair_tolerance_s) return Capture{std::move(left), std::move(*right)};
    if (apart_s > 0) {
      right = right_->next(left_ms());
      continue;
    }
    auto next_left = left_->next(left_ms());
    if (!next_left) return tl::unexpected<Error>(next_left.error());
    left = std::move(*next_left);
  }
}

}  // namespace

std::unique_ptr<FrameSource> make_bumblebee_source(BumblebeeOptions options, StereoToFrame to_frame) {
  return std::make_unique<BumblebeeSource>(std::move(options), std::move(to_frame));
}

std::vector<BumblebeeDevice> list_bumblebee_devices() {
  std::vector<BumblebeeDevice> devices;
  for (const LinkedCamera& camera : list_aravis_cameras()) devices.push_back({camera.id, camera.model, camera.serial});
#ifdef GFP_HAS_DC1394
  for (const LinkedCamera& camera : list_firewire_cameras(BumblebeeOptions{}.firewire_library)) devices.push_back({camera.id, camera.model + " (transport: firewire)", camera.serial});
#endif
  return devices;
}

}  // namespace gfp
