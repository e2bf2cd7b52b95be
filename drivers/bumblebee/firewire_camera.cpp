#include "bumblebee/firewire_camera.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <utility>

#include "bumblebee/dc1394_api.hpp"

namespace gfp {
namespace {

constexpr std::uint32_t kBuffers = 8, kBacklog = 4;  // beyond it the consumer is too slow: it gets what is new
constexpr auto kMode = DC1394_VIDEO_MODE_FORMAT7_3;  // both eyes in one picture
constexpr Nanoseconds kMaxAge = std::chrono::seconds(5);

std::string text(const char* from) { return from != nullptr ? from : ""; }

std::optional<std::uint64_t> parse_guid(const std::string& digits) {
  std::uint64_t guid = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), guid, 16);
  return error == std::errc{} && end == digits.data() + digits.size() ? std::optional(guid) : std::nullopt;
}

/// The XB3's three eyes take a byte each of RGB8, which is what its pixels are called.
dc1394color_coding_t coding_of(const std::string& pixel_format, const std::string& model) {
  if (pixel_format == "Raw16") return DC1394_COLOR_CODING_RAW16;
  if (pixel_format == "RGB8" || (pixel_format.empty() && model.find("XB3") != std::string::npos)) return DC1394_COLOR_CODING_RGB8;
  return DC1394_COLOR_CODING_MONO16;
}

}  // namespace

struct FirewireCamera::Handles {
  std::unique_ptr<Dc1394Api> api;
  dc1394_t* bus = nullptr;
  dc1394camera_t* camera = nullptr;
  bool captures = false;
  std::uint64_t pictures = 0;
};

FirewireCamera::FirewireCamera() : handles_(std::make_unique<Handles>()) {}

FirewireCamera::~FirewireCamera() {
  const Handles& h = *handles_;
  if (h.captures) h.api->video_set_transmission_(h.camera, DC1394_OFF), h.api->capture_stop_(h.camera);
  if (h.camera != nullptr) h.api->camera_free_(h.camera);
  if (h.bus != nullptr) h.api->free_(h.bus);
}

Result<std::unique_ptr<FirewireCamera>> FirewireCamera::open(const std::string& device, const BumblebeeOptions& options) {
  auto api = Dc1394Api::load(options.firewire_library);
  if (!api) return tl::unexpected<Error>(api.error());
  std::unique_ptr<FirewireCamera> camera(new FirewireCamera);
  camera->handles_->api = std::move(*api);
  auto opened = camera->find(device).and_then([&] { return camera->configure(options); }).and_then([&] { return camera->start(); });
  if (!opened) return tl::unexpected<Error>(opened.error());
  return camera;
}

Result<void> FirewireCamera::find(const std::string& device) {
  Handles& h = *handles_;
  const auto wanted = device.empty() ? std::optional<std::uint64_t>(0) : parse_guid(device);
  if (!wanted) return failure(ErrorCode::kInvalidArgument, fmt::format("bumblebee: input = {}, expected a GUID of 16 hexadecimal digits, or nothing for the first camera", device));
  h.bus = h.api->new_();
  dc1394camera_list_t* list = nullptr;
  if (h.bus == nullptr || h.api->camera_enumerate_(h.bus, &list) != DC1394_SUCCESS || list == nullptr) return failure(ErrorCode::kDeviceLost, "FireWire: no bus can be used (is firewire-ohci loaded, may the user open /dev/fw*?)");
  std::uint64_t guid = 0;
  for (std::uint32_t i = 0; i < list->num && guid == 0; ++i)
    if (device.empty() || list->ids[i].guid == *wanted) guid = list->ids[i].guid;
  const auto found = list->num;
  h.api->camera_free_list_(list);
  if (guid != 0) h.camera = h.api->camera_new_(h.bus, guid);
  if (h.camera == nullptr) return failure(ErrorCode::kDeviceLost, fmt::format("FireWire: {} is not on the bus ({} cameras are)", device.empty() ? "a camera" : device, found));
  model_ = text(h.camera->vendor) + " " + text(h.camera->model);
  return {};
}

Result<void> FirewireCamera::configure(const BumblebeeOptions& options) {
  const Handles& h = *handles_;
  const auto done = [&](dc1394error_t status, const char* what) -> Result<void> {
    if (status == DC1394_SUCCESS) return {};
    return failure(ErrorCode::kUnsupported, fmt::format("{}: {} is refused: {}", model_, what, h.api->error_get_string_(status)));
  };
  h.api->video_set_transmission_(h.camera, DC1394_OFF);  // a program that died may have left it running
  const bool fast = h.camera->bmode_capable == DC1394_TRUE && h.api->video_set_operation_mode_(h.camera, DC1394_OPERATION_MODE_1394B) == DC1394_SUCCESS;
  std::uint32_t width = 0, height = 0;
  return done(h.api->video_set_iso_speed_(h.camera, fast ? DC1394_ISO_SPEED_800 : DC1394_ISO_SPEED_400), "the bus speed")
      .and_then([&] { return done(h.api->video_set_mode_(h.camera, kMode), "format 7 mode 3"); })
      .and_then([&] { return done(h.api->format7_get_max_image_size_(h.camera, kMode, &width, &height), "to tell its size"); })
      .and_then([&] {
        const auto coding = coding_of(options.pixel_format, model_);
        return done(h.api->format7_set_roi_(h.camera, kMode, coding, DC1394_USE_MAX_AVAIL, 0, 0, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)), "bumblebee.pixel_format");
      })
      .and_then([&]() -> Result<void> {
        if (options.exposure_us <= 0) return {};
        const bool absolute = h.api->feature_set_absolute_control_(h.camera, DC1394_FEATURE_SHUTTER, DC1394_ON) == DC1394_SUCCESS;
        return done(absolute ? h.api->feature_set_absolute_value_(h.camera, DC1394_FEATURE_SHUTTER, static_cast<float>(1e-6 * options.exposure_us)) : DC1394_FAILURE, "bumblebee.exposure_us");
      });
}

Result<void> FirewireCamera::start() {
  Handles& h = *handles_;
  const auto lost = [&](dc1394error_t status, const char* what) { return failure(ErrorCode::kDeviceLost, fmt::format("{}: {}: {}", model_, what, h.api->error_get_string_(status))); };
  if (const auto status = h.api->capture_setup_(h.camera, kBuffers, DC1394_CAPTURE_FLAGS_DEFAULT); status != DC1394_SUCCESS) return lost(status, "no bandwidth, channel or memory");
  h.captures = true;
  if (const auto status = h.api->video_set_transmission_(h.camera, DC1394_ON); status != DC1394_SUCCESS) return lost(status, "it does not start");
  return {};
}

Result<Transfer> FirewireCamera::next(std::chrono::milliseconds timeout) {
  Handles& h = *handles_;
  pollfd wait{h.api->capture_get_fileno_(h.camera), POLLIN, 0};
  if (poll(&wait, 1, static_cast<int>(timeout.count())) <= 0) return failure(ErrorCode::kTimeout, fmt::format("{}: no picture within {} ms", model_, timeout.count()));
  const auto gone = [&](dc1394error_t status) { return failure(ErrorCode::kDeviceLost, fmt::format("{} is gone: {}", model_, h.api->error_get_string_(status))); };
  dc1394video_frame_t* raw = nullptr;
  const auto take = [&] { return raw = nullptr, h.api->capture_dequeue_(h.camera, DC1394_CAPTURE_POLICY_POLL, &raw); };
  auto status = take();
  for (std::uint32_t behind = raw != nullptr && raw->frames_behind > kBacklog ? raw->frames_behind : 0; behind > 0 && raw != nullptr; --behind, ++h.pictures) h.api->capture_enqueue_(h.camera, raw), status = take();
  if (status != DC1394_SUCCESS || (wait.revents & (POLLERR | POLLHUP)) != 0) return gone(status);
  if (raw == nullptr) return failure(ErrorCode::kTimeout, fmt::format("{}: no picture within {} ms", model_, timeout.count()));
  const std::unique_ptr<dc1394video_frame_t, std::function<void(dc1394video_frame_t*)>> back(raw, [&h](dc1394video_frame_t* used) { h.api->capture_enqueue_(h.camera, used); });
  Transfer transfer;
  transfer.number = h.pictures++;
  const std::uint64_t row_bytes = raw->size[0] > 0 ? raw->stride / raw->size[0] * raw->size[0] : 0;  // whole pixels
  if (h.api->capture_is_frame_corrupt_(h.camera, raw) == DC1394_TRUE || row_bytes == 0 || raw->size[1] == 0 || std::uint64_t{raw->stride} * (raw->size[1] - 1) + row_bytes > raw->total_bytes)
    return failure(ErrorCode::kCorruptFrame, fmt::format("{}: an incomplete picture", model_));
  transfer.device = std::chrono::microseconds(static_cast<std::int64_t>(raw->timestamp));
  transfer.arrival = monotonic_now() - std::clamp(realtime_now() - transfer.device, Nanoseconds::zero(), kMaxAge);
  transfer.width = static_cast<int>(raw->size[0]);
  transfer.height = static_cast<int>(raw->size[1]);
  transfer.bytes_per_pixel = static_cast<int>(row_bytes / raw->size[0]);
  for (std::uint32_t v = 0; v < raw->size[1]; ++v) transfer.bytes.insert(transfer.bytes.end(), raw->image + std::size_t{v} * raw->stride, raw->image + std::size_t{v} * raw->stride + row_bytes);
  return transfer;
}

std::vector<LinkedCamera> list_firewire_cameras(const std::string& library) {
  std::vector<LinkedCamera> cameras;
  const auto api = Dc1394Api::load(library);
  if (!api) return cameras;
  dc1394_t* const bus = (*api)->new_();
  dc1394camera_list_t* list = nullptr;
  if (bus != nullptr && (*api)->camera_enumerate_(bus, &list) == DC1394_SUCCESS && list != nullptr) {
    for (std::uint32_t i = 0; i < list->num; ++i)
      if (dc1394camera_t* const camera = (*api)->camera_new_(bus, list->ids[i].guid)) {
        const std::string guid = fmt::format("{:016x}", camera->guid);
        cameras.push_back({guid, text(camera->vendor) + " " + text(camera->model), guid});
        (*api)->camera_free_(camera);
      }
    (*api)->camera_free_list_(list);
  }
  if (bus != nullptr) (*api)->free_(bus);
  return cameras;
}

}  // namespace gfp
