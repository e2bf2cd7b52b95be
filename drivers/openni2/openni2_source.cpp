#include "openni2/openni2_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "gfp/frame/pacer.hpp"
#include "gfp/frame/session_clock.hpp"
#include "openni2/oni_records.hpp"
#include "openni2/openni2_api.hpp"

// open: library -> device -> streams -> (recorder) -> start (-> the recorder is seen to record)
// grab: waits for either stream; a colour frame is kept, a depth frame is returned with it
// A disconnection is told on a thread of OpenNI2's own, through `lost_`.
//
// OpenNI2 keeps one frame a stream and replaces it with the next. That is right for a device. A file is played in its manual mode, where each wait asks
// for one frame, and waits until it comes: a wait that is given up and begun anew asks for two, of which a busy machine loses one. The rhythm is ours.

namespace gfp {
namespace {

constexpr Nanoseconds kMaxColorLag = std::chrono::milliseconds(50);
constexpr int kSlice_ms = 50;            // a disconnection does not wake a wait
constexpr int kFilePatience_ms = 10'000; // a file's frame is there once it is decoded
constexpr Nanoseconds kRecorderPatience = std::chrono::seconds(10);

bool is_file(const std::string& uri) { return uri.ends_with(".oni"); }

/// A frame that goes back to OpenNI2.
class FrameHandle {
 public:
  FrameHandle(const OpenNi2Api& api, OniFrame* frame) : api_(api), frame_(frame) {}
  ~FrameHandle() { api_.FrameRelease(frame_); }
  FrameHandle(const FrameHandle&) = delete;
  FrameHandle& operator=(const FrameHandle&) = delete;
  const OniFrame* operator->() const { return frame_; }

 private:
  const OpenNi2Api& api_;
  OniFrame* frame_;
};

/// Rows of `width` pixels out of a frame, turned back where it is mirrored.
template <class Pixel>
bool copy_pixels(const OniFrame& frame, bool mirrored, Image<Pixel>& image) {
  const auto row_bytes = static_cast<std::size_t>(image.width) * sizeof(Pixel);
  const bool fits = frame.width == image.width && frame.height == image.height && frame.stride >= static_cast<int>(row_bytes) && frame.data != nullptr &&
                    frame.dataSize >= frame.stride * (frame.height - 1) + static_cast<int>(row_bytes);
  if (!fits) return false;
  for (int v = 0; v < image.height; ++v) {
    Pixel* row = &image.at(0, v);
    std::memcpy(static_cast<void*>(row), static_cast<const char*>(frame.data) + static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.stride), row_bytes);
    if (mirrored) std::reverse(row, row + image.width);
  }
  return true;
}

class OpenNi2Source final : public FrameSource {
 public:
  explicit OpenNi2Source(OpenNi2Options options) : options_(std::move(options)) {}
  ~OpenNi2Source() override { close(); }

  SourceInfo info() const override { return {"openni2", model_, options_.uri, options_.rate_hz, 0.4, 10.0, is_file(options_.uri)}; }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

 private:
  /// One of the device's streams.
  struct Stream {
    OniStreamHandle handle = nullptr;
    OniVideoMode mode{};
    bool mirrored = false;
  };

  Result<void> open_device();
  Result<void> open_streams();
  Result<void> open_stream(Stream& stream, OniSensorType sensor, OniPixelFormat format);
  Result<void> take_camera();
  Result<void> start();
  Result<void> record();
  Result<void> see_it_record();
  void drop_what_waits();
  Result<void> fetch(Nanoseconds deadline);
  Result<std::optional<Frame>> read(Stream& stream);
  Frame make_frame(Image<std::uint16_t> depth, std::uint64_t timestamp_us);
  template <class Value>
  bool property(const Stream& stream, int id, Value& value) const {
    int bytes = sizeof(Value);
    return api_->StreamGetProperty(stream.handle, id, &value, &bytes) == ONI_STATUS_OK && bytes == sizeof(Value);
  }
  static void ONI_CALLBACK_TYPE disconnected(const OniDeviceInfo* device, void* self);
  static void ONI_CALLBACK_TYPE state_changed(const OniDeviceInfo* device, OniDeviceState state, void* self);
  static void ONI_CALLBACK_TYPE connected(const OniDeviceInfo*, void*) {}

  OpenNi2Options options_;
  std::string model_ = "OpenNI2 device";
  std::shared_ptr<OpenNi2Api> api_;
  OniDeviceHandle device_ = nullptr;
  OniCallbackHandle callbacks_ = nullptr;
  OniRecorderHandle recorder_ = nullptr;
  std::string device_uri_;
  Stream depth_, color_;
  CameraModel camera_;
  std::atomic<bool> lost_{false}, ended_{false};
  std::optional<std::uint64_t> frames_left_;  ///< Of a file.
  std::uint64_t to_skip_ = 0;
  std::optional<int> last_index_;            ///< Of the last depth frame, as the file counts.
  std::uint64_t lost_before_next_ = 0;       ///< Frames of a file.
  std::optional<Frame> next_;                ///< Read, not due yet.
  Pacer pacer_;
  Image<Rgb8> last_color_;
  std::optional<std::uint64_t> color_us_;
  SessionClock clock_;
  std::uint64_t sequence_ = 0;
};

void OpenNi2Source::disconnected(const OniDeviceInfo* device, void* self) {
  auto& source = *static_cast<OpenNi2Source*>(self);
  if (source.device_uri_ == device->uri) source.lost_ = true;
}

/// Frames that were read ahead may still be waiting when a file says that it is at its end.
void OpenNi2Source::state_changed(const OniDeviceInfo* device, OniDeviceState state, void* self) {
  auto& source = *static_cast<OpenNi2Source*>(self);
  if (source.device_uri_ == device->uri && state == ONI_DEVICE_STATE_EOF) source.ended_ = true;
}

Result<void> OpenNi2Source::open() {
  close();
  std::error_code error;
  if (is_file(options_.uri) && !std::filesystem::is_regular_file(options_.uri, error)) return failure(ErrorCode::kNotFound, fmt::format("{}: no such file", options_.uri));
  auto api = OpenNi2Api::acquire(options_.library);
  if (!api) return tl::unexpected<Error>(api.error());
  api_ = std::move(*api);
  auto opened = open_device().and_then([this] { return open_streams(); }).and_then([this] { return take_camera(); }).and_then([this] { return start(); });
  if (!opened) close();
  return opened;
}

Result<void> OpenNi2Source::open_device() {
  if (api_->DeviceOpen(options_.uri.empty() ? nullptr : options_.uri.c_str(), &device_) != ONI_STATUS_OK) {
    device_ = nullptr;
    if (is_file(options_.uri)) return failure(ErrorCode::kCorruptData, fmt::format("{}: no recording that OpenNI2 reads ({})", options_.uri, api_->why()));
    return failure(ErrorCode::kDeviceLost, fmt::format("OpenNI2: {} cannot be opened: {}", options_.uri.empty() ? "no device" : options_.uri, api_->why()));
  }
  OniDeviceInfo info{};
  api_->DeviceGetInfo(device_, &info);
  device_uri_ = info.uri;
  model_ = fmt::format("{} {}", info.vendor, info.name);
  lost_ = ended_ = false;
  OniDeviceCallbacks callbacks{connected, disconnected, state_changed};
  api_->RegisterDeviceCallbacks(&callbacks, this, &callbacks_);
  if (!is_file(options_.uri)) return {};
  // -1: every frame waits until it is asked for. No repeat, else the recording never ends.
  const OniBool repeat = FALSE;
  const float speed = -1.0F;
  api_->DeviceSetProperty(device_, ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED, &repeat, sizeof(repeat));
  api_->DeviceSetProperty(device_, ONI_DEVICE_PROPERTY_PLAYBACK_SPEED, &speed, sizeof(speed));
  return {};
}

Result<void> OpenNi2Source::open_streams() {
  if (auto depth = open_stream(depth_, ONI_SENSOR_DEPTH, ONI_PIXEL_FORMAT_DEPTH_1_MM); !depth) return depth;
  if (!options_.color || !open_stream(color_, ONI_SENSOR_COLOR, ONI_PIXEL_FORMAT_RGB888)) color_ = {};
  const OniImageRegistrationMode registered = ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  if (color_.handle != nullptr && api_->DeviceIsImageRegistrationModeSupported(device_, registered))
    api_->DeviceSetProperty(device_, ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION, &registered, sizeof(registered));
  return {};
}

Result<void> OpenNi2Source::open_stream(Stream& stream, OniSensorType sensor, OniPixelFormat format) {
  const char* const name = sensor == ONI_SENSOR_DEPTH ? "depth" : "colour";
  if (api_->DeviceCreateStream(device_, sensor, &stream.handle) != ONI_STATUS_OK) {
    stream.handle = nullptr;
    return failure(ErrorCode::kUnsupported, fmt::format("{}: has no {} stream: {}", device_uri_, name, api_->why()));
  }
  if (!is_file(options_.uri)) {
    const OniVideoMode wanted{format, options_.width, options_.height, static_cast<int>(std::lround(options_.rate_hz))};
    const OniBool mirror = FALSE;
    api_->StreamSetProperty(stream.handle, ONI_STREAM_PROPERTY_VIDEO_MODE, &wanted, sizeof(wanted));
    api_->StreamSetProperty(stream.handle, ONI_STREAM_PROPERTY_MIRRORING, &mirror, sizeof(mirror));
  }
  OniBool mirrored = FALSE;
  stream.mirrored = property(stream, ONI_STREAM_PROPERTY_MIRRORING, mirrored) && mirrored != FALSE;
  const bool known = property(stream, ONI_STREAM_PROPERTY_VIDEO_MODE, stream.mode);
  if (known && stream.mode.pixelFormat == format && stream.mode.resolutionX >= 1 && stream.mode.resolutionX <= kMaxImageSide && stream.mode.resolutionY >= 1 &&
      stream.mode.resolutionY <= kMaxImageSide)
    return {};
  api_->StreamDestroy(std::exchange(stream.handle, nullptr));
  return failure(ErrorCode::kUnsupported, fmt::format("{}: {} is {} x {} in format {}, expected format {}", device_uri_, name, stream.mode.resolutionX,
                                                      stream.mode.resolutionY, static_cast<int>(stream.mode.pixelFormat), static_cast<int>(format)));
}

/// The given camera, or that of the fields of view; the principal point is in the middle, as OpenNI2 assumes throughout.
Result<void> OpenNi2Source::take_camera() {
  CameraModel camera = default_kinect_camera(depth_.mode.resolutionX, depth_.mode.resolutionY);
  float across = 0, down = 0;
  const auto usable = [](float angle) { return angle > 0.05F && angle < 3.0F; };
  if (options_.camera) {
    camera = options_.camera->camera;
  } else if (property(depth_, ONI_STREAM_PROPERTY_HORIZONTAL_FOV, across) && property(depth_, ONI_STREAM_PROPERTY_VERTICAL_FOV, down) && usable(across) && usable(down)) {
    camera.fx = 0.5 * camera.width / std::tan(0.5 * across);
    camera.fy = 0.5 * camera.height / std::tan(0.5 * down);
  }
  auto checked = camera_for_image(std::move(camera), depth_.mode.resolutionX, depth_.mode.resolutionY);
  if (!checked) return tl::unexpected<Error>(checked.error());
  camera_ = std::move(*checked);
  return {};
}

Result<void> OpenNi2Source::start() {
  int frames = 0;
  frames_left_.reset();
  if (is_file(options_.uri) && property(depth_, ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES, frames)) frames_left_ = static_cast<std::uint64_t>(std::max(0, frames));
  to_skip_ = is_file(options_.uri) ? options_.first_frame : 0;
  color_us_.reset();
  last_index_.reset();
  next_.reset();
  pacer_.restart();
  clock_.restart();
  last_color_ = Image<Rgb8>(color_.mode.resolutionX, color_.mode.resolutionY);
  if (auto recording = record(); !recording) return recording;
  if (recorder_ != nullptr && api_->RecorderStart(recorder_) != ONI_STATUS_OK) return failure(ErrorCode::kIo, fmt::format("{}: {}", options_.record, api_->why()));
  for (const Stream* stream : {&depth_, &color_})
    if (stream->handle != nullptr && api_->StreamStart(stream->handle) != ONI_STATUS_OK) return failure(ErrorCode::kDeviceLost, fmt::format("{}: cannot be started: {}", device_uri_, api_->why()));
  return recorder_ != nullptr ? see_it_record() : Result<void>{};
}

/// The recorder starts on a thread of its own, some time after it was told to, and says nothing: its file does. From its first frame on it takes every one,
/// so what came before that is let go.
Result<void> OpenNi2Source::see_it_record() {
  const Nanoseconds deadline = monotonic_now() + kRecorderPatience;
  while (!oni_file_has_frames(options_.record)) {
    if (monotonic_now() > deadline) return failure(ErrorCode::kDeviceLost, fmt::format("openni2.record = {}: no frame to record within 10 s", options_.record));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  drop_what_waits();
  return {};
}

void OpenNi2Source::drop_what_waits() {
  for (Stream* stream : {&depth_, &color_}) {
    int ready = -1;
    OniFrame* frame = nullptr;
    if (stream->handle == nullptr || api_->WaitForAnyStream(&stream->handle, 1, &ready, ONI_TIMEOUT_NONE) != ONI_STATUS_OK) continue;
    if (api_->StreamReadFrame(stream->handle, &frame) == ONI_STATUS_OK && frame != nullptr) api_->FrameRelease(frame);
  }
}

Result<void> OpenNi2Source::record() {
  if (options_.record.empty()) return {};
  if (api_->CreateRecorder(options_.record.c_str(), &recorder_) != ONI_STATUS_OK) {
    recorder_ = nullptr;
    return failure(ErrorCode::kIo, fmt::format("openni2.record = {}: {}", options_.record, api_->why()));
  }
  const OniBool lossy = FALSE;
  for (const Stream* stream : {&depth_, &color_})
    if (stream->handle != nullptr && api_->RecorderAttachStream(recorder_, stream->handle, lossy) != ONI_STATUS_OK)
      return failure(ErrorCode::kIo, fmt::format("openni2.record = {}: {}", options_.record, api_->why()));
  return {};
}

Result<Frame> OpenNi2Source::grab(std::chrono::milliseconds timeout) {
  if (device_ == nullptr) return failure(ErrorCode::kDeviceLost, "the device is not open");
  const Nanoseconds deadline = monotonic_now() + timeout;
  if (!next_)
    if (const auto fetched = fetch(deadline); !fetched) return tl::unexpected<Error>(fetched.error());
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(std::max(Nanoseconds::zero(), deadline - monotonic_now()));
  if (is_file(options_.uri) && !options_.fast && !pacer_.wait_until_due(next_->stamps.sensor, left)) return failure(ErrorCode::kTimeout, fmt::format("the next frame is not due within {} ms", timeout.count()));
  Frame frame = *std::exchange(next_, std::nullopt);
  frame.stamps.monotonic = options_.frame_time ? frame.stamps.sensor : monotonic_now();
  frame.stamps.realtime = options_.frame_time ? frame.stamps.sensor : realtime_now();
  return frame;
}

/// Waits for the next depth frame and puts it into `next_`.
Result<void> OpenNi2Source::fetch(Nanoseconds deadline) {
  std::array<OniStreamHandle, 2> streams{color_.handle, depth_.handle};  // of one instant, colour comes first: it belongs to this depth
  const int first = color_.handle != nullptr ? 0 : 1;
  while (true) {
    if (lost_) return failure(ErrorCode::kDeviceLost, fmt::format("{} is gone", device_uri_));
    if (frames_left_ == 0U) return failure(ErrorCode::kEndOfStream, "the recording has come to its end");
    const bool at_end = ended_;
    const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - monotonic_now()).count();
    if (left_ms <= 0 && !is_file(options_.uri)) return failure(ErrorCode::kTimeout, "no depth frame in time");
    const int wait_ms = at_end ? ONI_TIMEOUT_NONE : is_file(options_.uri) ? kFilePatience_ms : static_cast<int>(std::min<std::int64_t>(left_ms, kSlice_ms));
    int ready = -1;
    const auto status = api_->WaitForAnyStream(&streams[static_cast<std::size_t>(first)], 2 - first, &ready, wait_ms);
    if (status == ONI_STATUS_TIME_OUT && at_end) return failure(ErrorCode::kEndOfStream, "the recording has come to its end before the frames it promised");
    if (status == ONI_STATUS_TIME_OUT) continue;
    if (status != ONI_STATUS_OK) return failure(ErrorCode::kDeviceLost, fmt::format("{}: {}", device_uri_, api_->why()));
    auto frame = read(first + ready == 0 ? color_ : depth_);
    if (!frame) return tl::unexpected<Error>(frame.error());
    if (!*frame) continue;
    next_ = std::move(**frame);
    if (const auto lost = std::exchange(lost_before_next_, 0); lost > 0) return failure(ErrorCode::kCorruptFrame, fmt::format("{}: OpenNI2 lost {} frames", device_uri_, lost));
    return {};
  }
}

/// A depth frame that is to be delivered, or nothing: colour is kept, what is before the first frame is passed over.
Result<std::optional<Frame>> OpenNi2Source::read(Stream& stream) {
  OniFrame* raw = nullptr;
  if (api_->StreamReadFrame(stream.handle, &raw) != ONI_STATUS_OK || raw == nullptr) return failure(ErrorCode::kDeviceLost, fmt::format("{}: {}", device_uri_, api_->why()));
  const FrameHandle frame(*api_, raw);
  if (&stream == &color_) {
    if (copy_pixels(*raw, stream.mirrored, last_color_)) color_us_ = frame->timestamp;
    return std::nullopt;
  }
  lost_before_next_ = is_file(options_.uri) && last_index_ ? static_cast<std::uint64_t>(std::max(0, frame->frameIndex - *last_index_ - 1)) : 0;
  last_index_ = frame->frameIndex;
  if (frames_left_) *frames_left_ -= std::min(*frames_left_, 1 + lost_before_next_);
  if (to_skip_ > 0) return to_skip_ -= std::min(to_skip_, 1 + lost_before_next_), std::nullopt;
  Image<std::uint16_t> depth(stream.mode.resolutionX, stream.mode.resolutionY);
  if (!copy_pixels(*raw, stream.mirrored, depth))
    return failure(ErrorCode::kCorruptFrame, fmt::format("{}: a depth frame of {} x {}, expected {} x {}", device_uri_, frame->width, frame->height, depth.width, depth.height));
  return make_frame(std::move(depth), frame->timestamp);
}

Frame OpenNi2Source::make_frame(Image<std::uint16_t> depth, std::uint64_t timestamp_us) {
  Frame frame;
  frame.sensor = options_.sensor;
  frame.sequence = sequence_++;
  frame.stamps.sensor = clock_.stamp(std::chrono::microseconds(static_cast<std::int64_t>(timestamp_us)));
  frame.depth = {std::move(depth), 0.001};
  frame.camera = camera_;
  frame.noise = options_.noise;
  if (options_.camera) frame.T_world_sensor = options_.camera->T_world_sensor;
  const auto lag_us = static_cast<std::int64_t>(timestamp_us - color_us_.value_or(0));
  const bool same_size = last_color_.width == frame.depth.pixels.width && last_color_.height == frame.depth.pixels.height;
  if (color_us_ && same_size && std::chrono::microseconds(std::abs(lag_us)) <= kMaxColorLag) frame.color = last_color_;
  return frame;
}

void OpenNi2Source::close() noexcept {
  if (api_ == nullptr) return;
  if (recorder_ != nullptr) {
    api_->RecorderStop(recorder_);
    api_->RecorderDestroy(&recorder_);
    recorder_ = nullptr;
  }
  for (Stream* stream : {&color_, &depth_}) {
    if (stream->handle == nullptr) continue;
    api_->StreamStop(stream->handle);
    api_->StreamDestroy(stream->handle);
    *stream = {};
  }
  if (callbacks_ != nullptr) api_->UnregisterDeviceCallbacks(std::exchange(callbacks_, nullptr));
  if (device_ != nullptr) api_->DeviceClose(std::exchange(device_, nullptr));
  api_.reset();
}

}  // namespace

std::unique_ptr<FrameSource> make_openni2_source(OpenNi2Options options) { return std::make_unique<OpenNi2Source>(std::move(options)); }

Result<std::vector<OpenNi2Device>> list_openni2_devices(const std::string& library) {
  auto api = OpenNi2Api::acquire(library);
  if (!api) return tl::unexpected<Error>(api.error());
  OniDeviceInfo* list = nullptr;
  int count = 0;
  if ((*api)->GetDeviceList(&list, &count) != ONI_STATUS_OK) return failure(ErrorCode::kIo, "OpenNI2: " + (*api)->why());
  std::vector<OpenNi2Device> devices;
  for (int i = 0; i < count; ++i) devices.push_back({list[i].uri, list[i].vendor, list[i].name});
  (*api)->ReleaseDeviceList(list);
  return devices;
}

}  // namespace gfp
