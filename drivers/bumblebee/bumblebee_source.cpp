#include "bumblebee/bumblebee_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bumblebee/aravis_camera.hpp"

namespace gfp {
namespace {

class BumblebeeSource final : public FrameSource {
 public:
  BumblebeeSource(BumblebeeOptions options, StereoToFrame to_frame) : options_(std::move(options)), to_frame_(std::move(to_frame)) {}

  SourceInfo info() const override { return {"bumblebee", "stereo camera", options_.device, options_.rate_hz, 0.2, 20.0, false, false}; }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override { left_.reset(), right_.reset(); }

 private:
  Result<StereoPair> decode(const Transfer& transfer) const;
  Result<StereoPair> pair_of_two(Transfer& left, Nanoseconds deadline);
  Nanoseconds session_stamp(Nanoseconds device);

  const BumblebeeOptions options_;
  const StereoToFrame to_frame_;
  std::unique_ptr<AravisCamera> left_, right_;  ///< The right one of two devices only.
  std::optional<Nanoseconds> first_device_;     ///< Since it was opened.
  Nanoseconds session_offset_{}, last_stamp_{-1};
  std::uint64_t sequence_ = 0;
};

Result<void> BumblebeeSource::open() {
  close();
  const std::size_t comma = options_.device.find(',');
  const bool two = options_.layout == "two_devices";
  if (two && (comma == 0 || comma == std::string::npos || comma + 1 == options_.device.size()))
    return failure(ErrorCode::kInvalidArgument, fmt::format("bumblebee: input = {}, expected LEFT,RIGHT for layout two_devices", options_.device));
  auto left = AravisCamera::open(two ? options_.device.substr(0, comma) : options_.device, options_);
  if (!left) return tl::unexpected<Error>(left.error());
  left_ = std::move(*left);
  if (two) {
    auto right = AravisCamera::open(options_.device.substr(comma + 1), options_);
    if (!right) return close(), tl::unexpected<Error>(right.error());
    right_ = std::move(*right);
  }
  first_device_.reset();
  session_offset_ = last_stamp_ + Nanoseconds(1);
  return {};
}

Result<Frame> BumblebeeSource::grab(std::chrono::milliseconds timeout) {
  if (left_ == nullptr) return failure(ErrorCode::kDeviceLost, "the stereo camera is not open");
  const Nanoseconds deadline = monotonic_now() + timeout;
  auto transfer = left_->next(timeout);
  if (!transfer) return tl::unexpected<Error>(transfer.error());
  auto pair = right_ != nullptr ? pair_of_two(*transfer, deadline) : decode(*transfer);
  if (!pair) return tl::unexpected<Error>(pair.error());
  take_off_mosaic(*pair, options_.bayer, options_.color);
  Frame frame;
  frame.sensor = options_.sensor;
  frame.sequence = sequence_++;
  frame.stamps = {session_stamp(transfer->device), transfer->arrival, realtime_now() - (monotonic_now() - transfer->arrival)};
  return to_frame_(*pair, frame).map([&] { return std::move(frame); });
}

Result<StereoPair> BumblebeeSource::decode(const Transfer& transfer) const { return options_.layout == "stacked" ? decode_stacked(transfer.picture()) : decode_interleaved(transfer.picture(), options_.first_byte); }

/// The eyes arrive apart: the older one is left out until both are of one instant.
Result<StereoPair> BumblebeeSource::pair_of_two(Transfer& left, Nanoseconds deadline) {
  const auto left_ms = [&] { return std::chrono::duration_cast<std::chrono::milliseconds>(std::max(Nanoseconds::zero(), deadline - monotonic_now())); };
  auto right = right_->next(left_ms());
  while (true) {
    if (!right) return tl::unexpected<Error>(right.error());
    const double apart_s = std::chrono::duration<double>(left.arrival - right->arrival).count();
    if (std::abs(apart_s) <= options_.pair_tolerance_s) break;
    if (apart_s > 0) {
      right = right_->next(left_ms());
      continue;
    }
    auto next_left = left_->next(left_ms());
    if (!next_left) return tl::unexpected<Error>(next_left.error());
    left = std::move(*next_left);
  }
  auto left_eye = decode_single(left.picture()), right_eye = decode_single(right->picture());
  if (!left_eye) return tl::unexpected<Error>(left_eye.error());
  if (!right_eye) return tl::unexpected<Error>(right_eye.error());
  return StereoPair{std::move(*left_eye), std::move(*right_eye), {}};
}

/// The camera's 64-bit clock as time of the session, strictly rising, also over a reopening.
Nanoseconds BumblebeeSource::session_stamp(Nanoseconds device) {
  if (!first_device_) first_device_ = device;
  last_stamp_ = std::max(session_offset_ + (device - *first_device_), last_stamp_ + Nanoseconds(1));
  return last_stamp_;
}

}  // namespace

std::unique_ptr<FrameSource> make_bumblebee_source(BumblebeeOptions options, StereoToFrame to_frame) {
  return std::make_unique<BumblebeeSource>(std::move(options), std::move(to_frame));
}

std::vector<BumblebeeDevice> list_bumblebee_devices() {
  std::vector<BumblebeeDevice> devices;
  for (const AravisDevice& device : list_aravis_devices()) devices.push_back({device.id, device.model, device.serial});
  return devices;
}

}  // namespace gfp
