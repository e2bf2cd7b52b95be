#include "bumblebee/aravis_camera.hpp"

extern "C" {
#include <arv.h>
}
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

namespace gfp {
namespace {

constexpr int kBuffers = 12, kBacklog = 4;  // beyond it the consumer is too slow, no longer delayed: it gets what is new, and Aravis keeps buffers to fill
constexpr guint kFramePatience_us = 1'000'000;
constexpr Nanoseconds kMaxAge = std::chrono::seconds(5);  // of a picture that waited; more is a host clock that was set
constexpr std::uint64_t kMaxPayload = std::uint64_t{256} << 20;

/// Collects Aravis' error; true in a condition where there was one.
class Failure {
 public:
  ~Failure() { g_clear_error(&error_); }
  Failure() = default;
  Failure(const Failure&) = delete;
  Failure& operator=(const Failure&) = delete;
  GError** out() { return g_clear_error(&error_), &error_; }
  explicit operator bool() const { return error_ != nullptr; }
  std::string why() const { return error_ != nullptr ? error_->message : "unknown"; }

 private:
  GError* error_ = nullptr;
};

std::string text(const char* from) { return from != nullptr ? from : ""; }

/// Copies the picture out; of several parts (GigE Vision's Multi-part), the first two pictures, one above the other.
Result<void> take_pixels(ArvBuffer* buffer, Transfer& transfer) {
  std::vector<guint> pictures;
  for (guint part = 0; part < arv_buffer_get_n_parts(buffer) && pictures.size() < 2; ++part)
    if (arv_buffer_get_part_data_type(buffer, part) == ARV_BUFFER_PART_DATA_TYPE_2D_IMAGE) pictures.push_back(part);
  if (pictures.empty()) return failure(ErrorCode::kCorruptFrame, "a transfer without a picture");
  const guint first = pictures.front(), last = pictures.back();
  const ArvPixelFormat pixel_format = arv_buffer_get_part_pixel_format(buffer, first);
  transfer.width = arv_buffer_get_part_width(buffer, first);
  transfer.height = arv_buffer_get_part_height(buffer, first);
  transfer.bytes_per_pixel = static_cast<int>(ARV_PIXEL_FORMAT_BIT_PER_PIXEL(pixel_format) / 8);
  if (arv_buffer_get_part_width(buffer, last) != transfer.width || arv_buffer_get_part_height(buffer, last) != transfer.height || arv_buffer_get_part_pixel_format(buffer, last) != pixel_format)
    return failure(ErrorCode::kCorruptFrame, fmt::format("its parts differ: {} x {} and {} x {}", transfer.width, transfer.height, arv_buffer_get_part_width(buffer, last), arv_buffer_get_part_height(buffer, last)));
  transfer.height *= static_cast<int>(pictures.size());
  for (const guint part : pictures) {
    std::size_t size = 0;
    // A lone part is all that came: not every transport of Aravis tells its size.
    const auto* const data = static_cast<const std::uint8_t*>(arv_buffer_get_n_parts(buffer) == 1 ? arv_buffer_get_data(buffer, &size) : arv_buffer_get_part_data(buffer, part, &size));
    transfer.bytes.insert(transfer.bytes.end(), data, data + size);
  }
  return {};
}

}  // namespace

struct AravisCamera::Handles {
  ArvCamera* camera = nullptr;
  ArvStream* stream = nullptr;
  gulong lost_signal = 0;
  std::atomic<bool> lost{false};
  bool silent = false;  ///< The last wait brought nothing.
  std::uint64_t pictures = 0;
};

AravisCamera::AravisCamera() : handles_(std::make_unique<Handles>()) {}

AravisCamera::~AravisCamera() {
  if (handles_->camera != nullptr) {
    if (handles_->lost_signal != 0) g_signal_handler_disconnect(arv_camera_get_device(handles_->camera), handles_->lost_signal);
    Failure ignored;
    if (!handles_->lost && !handles_->silent) arv_camera_stop_acquisition(handles_->camera, ignored.out());  // a camera that is gone would be waited for
  }
  g_clear_object(&handles_->stream);
  g_clear_object(&handles_->camera);
}

Result<std::unique_ptr<AravisCamera>> AravisCamera::open(const std::string& device, const BumblebeeOptions& options) {
  std::unique_ptr<AravisCamera> camera(new AravisCamera);
  Failure failed;
  camera->handles_->camera = arv_camera_new(device.empty() ? nullptr : device.c_str(), failed.out());
  if (failed || camera->handles_->camera == nullptr)
    return failure(ErrorCode::kDeviceLost, fmt::format("Aravis: {} cannot be opened: {}", device.empty() ? "no camera" : device, failed ? failed.why() : "none answers"));
  camera->model_ = text(arv_camera_get_vendor_name(camera->handles_->camera, failed.out())) + " " + text(arv_camera_get_model_name(camera->handles_->camera, failed.out()));
  if (auto set = camera->configure(options); !set) return tl::unexpected<Error>(set.error());
  if (auto started = camera->start(options); !started) return tl::unexpected<Error>(started.error());
  return camera;
}

Result<void> AravisCamera::configure(const BumblebeeOptions& options) {
  ArvCamera* const camera = handles_->camera;
  Failure failed;
  const auto refused = [&](const char* what) { return failure(ErrorCode::kUnsupported, fmt::format("{}: {} is refused: {}", model_, what, failed.why())); };
  arv_camera_stop_acquisition(camera, failed.out());  // a program that died may have left it running
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, failed.out());
  if (!options.pixel_format.empty()) arv_camera_set_pixel_format_from_string(camera, options.pixel_format.c_str(), failed.out());
  if (!options.pixel_format.empty() && failed) return refused(("bumblebee.pixel_format = " + options.pixel_format).c_str());
  if (options.exposure_us > 0) arv_camera_set_exposure_time(camera, options.exposure_us, failed.out());
  if (options.exposure_us > 0 && failed) return refused("bumblebee.exposure_us");
  if (options.rate_hz > 0) arv_camera_set_frame_rate(camera, options.rate_hz, failed.out());
  if (options.rate_hz > 0 && failed) return refused("bumblebee.rate_hz");
  if (!arv_camera_is_gv_device(camera)) return {};
  // With raw sockets (as root) nothing arrives from this machine itself, and elsewhere they buy little. The camera keeps the last client's packet size.
  arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  arv_camera_gv_set_packet_size(camera, options.packet_bytes, failed.out());
  if (failed) return refused("bumblebee.packet_bytes");
  if (options.packet_delay_ns > 0) arv_camera_gv_set_packet_delay(camera, options.packet_delay_ns, failed.out());
  if (options.packet_delay_ns > 0 && failed) return refused("bumblebee.packet_delay_ns");
  return {};
}

Result<void> AravisCamera::start(const BumblebeeOptions& options) {
  Failure failed;
  const auto lost = [&](const char* what) { return failure(ErrorCode::kDeviceLost, fmt::format("{}: {}: {}", model_, what, failed.why())); };
  const std::uint64_t payload = arv_camera_get_payload(handles_->camera, failed.out());
  if (failed || payload == 0 || payload > kMaxPayload) return lost("its payload cannot be told");
  handles_->stream = arv_camera_create_stream(handles_->camera, nullptr, nullptr, failed.out());
  if (failed || handles_->stream == nullptr) return lost("no stream");
  if (ARV_IS_GV_STREAM(handles_->stream))  // Aravis' own choice of buffer loses frames of 640 x 480 already; its patience with a frame is less than a busy machine's pauses
    g_object_set(handles_->stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", options.socket_buffer_bytes, "frame-retention", kFramePatience_us, nullptr);
  for (int i = 0; i < kBuffers; ++i) arv_stream_push_buffer(handles_->stream, arv_buffer_new(payload, nullptr));
  handles_->lost_signal = g_signal_connect(arv_camera_get_device(handles_->camera), "control-lost",
                                           G_CALLBACK(+[](ArvDevice*, Handles* handles) { handles->lost = true; }), handles_.get());
  arv_camera_start_acquisition(handles_->camera, failed.out());
  if (failed) return lost("it does not start");
  return {};
}

Result<Transfer> AravisCamera::next(std::chrono::milliseconds timeout) {
  if (handles_->lost) return failure(ErrorCode::kDeviceLost, fmt::format("{}: control was lost", model_));
  gint empty = 0, filled = 0;
  arv_stream_get_n_buffers(handles_->stream, &empty, &filled);
  for (int left_out = filled > kBacklog ? filled - 1 : 0; left_out > 0; --left_out, ++handles_->pictures) arv_stream_push_buffer(handles_->stream, arv_stream_pop_buffer(handles_->stream));
  ArvBuffer* const buffer = arv_stream_timeout_pop_buffer(handles_->stream, static_cast<guint64>(1000 * timeout.count()));
  handles_->silent = buffer == nullptr;
  if (buffer == nullptr && handles_->lost) return failure(ErrorCode::kDeviceLost, fmt::format("{}: control was lost", model_));
  if (buffer == nullptr) return failure(ErrorCode::kTimeout, fmt::format("{}: no picture within {} ms", model_, timeout.count()));
  const std::uint64_t number = handles_->pictures++;
  const std::unique_ptr<ArvBuffer, std::function<void(ArvBuffer*)>> back(buffer, [this](ArvBuffer* used) { arv_stream_push_buffer(handles_->stream, used); });
  if (const auto status = arv_buffer_get_status(buffer); status != ARV_BUFFER_STATUS_SUCCESS)
    return failure(ErrorCode::kCorruptFrame, fmt::format("{}: an incomplete picture (status {}): packets are missing", model_, static_cast<int>(status)));
  Transfer transfer;
  transfer.number = number;
  transfer.arrival = monotonic_now() - std::clamp(realtime_now() - Nanoseconds(static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer))), Nanoseconds::zero(), kMaxAge);
  transfer.device = Nanoseconds(static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer)));
  if (auto taken = take_pixels(buffer, transfer); !taken) return failure(taken.error().code, fmt::format("{}: {}", model_, taken.error().what));
  return transfer;
}

std::vector<LinkedCamera> list_aravis_cameras() {
  arv_update_device_list();
  std::vector<LinkedCamera> devices;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) devices.push_back({text(arv_get_device_id(i)), text(arv_get_device_vendor(i)) + " " + text(arv_get_device_model(i)), text(arv_get_device_serial_nbr(i))});
  return devices;
}

}  // namespace gfp
