#include "freenect/freenect_source.hpp"

#include <fmt/format.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "freenect/freenect_api.hpp"
#include "freenect/register_color.hpp"
#include "freenect/tick_clock.hpp"
#include "gfp/frame/session_clock.hpp"
#include "replay/fakenect.hpp"

// open -> (process_events -> depth_arrived / video_arrived, on the same thread) -> grab returns what arrived
//      -> close: stops, closes, unloads. A lost device and an ended folder are opened anew from nothing.

namespace gfp {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth) * kHeight;
constexpr Nanoseconds kMaxColorLag = std::chrono::milliseconds(50);
constexpr double kInfraredFocal_px = 575.8, kColorFocal_px = 525.0;

freenect_led_options led_of(const std::string& name) {
  static constexpr std::array<std::pair<const char*, freenect_led_options>, 6> kNames{{{"off", LED_OFF}, {"green", LED_GREEN}, {"red", LED_RED},
      {"yellow", LED_YELLOW}, {"blink_green", LED_BLINK_GREEN}, {"blink_red_yellow", LED_BLINK_RED_YELLOW}}};
  for (const auto& [known, led] : kNames)
    if (name == known) return led;
  return LED_GREEN;
}

CameraModel centred_camera(double focal_px) {
  CameraModel camera = default_kinect_camera(kWidth, kHeight);
  camera.fx = camera.fy = focal_px;
  return camera;
}

class FreenectSource final : public FrameSource {
 public:
  explicit FreenectSource(FreenectOptions options) : options_(std::move(options)) {}
  ~FreenectSource() override { close(); }

  SourceInfo info() const override {
    return {"freenect", options_.folder.empty() ? "Kinect v1" : "Kinect v1 (recorded)", options_.folder.empty() ? options_.serial : options_.folder, 30, 0.4, 9.0,
            !options_.folder.empty()};
  }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

 private:
  Result<void> check() const;
  Result<void> open_device();
  Result<void> start();
  void take_calibration();
  Frame make_frame(Nanoseconds stamp);

  static void depth_arrived(freenect_device* device, void* depth, std::uint32_t ticks);
  static void video_arrived(freenect_device* device, void* video, std::uint32_t ticks);

  FreenectOptions options_;
  std::unique_ptr<FreenectApi> api_;
  freenect_context* context_ = nullptr;
  freenect_device* device_ = nullptr;
  CameraModel camera_;
  KinectDepthTable table_{};
  Image<std::uint16_t> depth_;
  Image<Rgb8> color_;
  std::optional<std::uint32_t> depth_ticks_;  ///< Of a frame that nobody has taken yet.
  std::optional<std::uint32_t> color_ticks_;
  TickClock clock_;
  SessionClock session_;
  std::uint64_t sequence_ = 0;
};

/// Whose callbacks run: libfreenect calls them from within process_events, on the thread that called it.
thread_local FreenectSource* processing = nullptr;

void FreenectSource::depth_arrived(freenect_device*, void* depth, std::uint32_t ticks) {
  const auto* values = static_cast<const std::uint16_t*>(depth);
  processing->depth_.pixels.assign(values, values + kPixels);
  processing->depth_ticks_ = ticks;
}

void FreenectSource::video_arrived(freenect_device*, void* video, std::uint32_t ticks) {
  const auto* bytes = static_cast<const std::uint8_t*>(video);
  for (std::size_t i = 0; i < kPixels; ++i) processing->color_.pixels[i] = {bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]};
  processing->color_ticks_ = ticks;
}

Result<void> FreenectSource::check() const {
  if (options_.folder.empty()) return {};
  if (options_.depth != "raw") return failure(ErrorCode::kInvalidArgument, fmt::format("freenect.depth = {}, expected raw: a recorded folder holds nothing else", options_.depth));
  const auto frames = list_fakenect_folder(options_.folder);
  if (!frames) return tl::unexpected<Error>(frames.error());
  const auto first = read_fakenect_raw(frames->front().depth);
  if (!first) return tl::unexpected<Error>(first.error());
  if (first->width != kWidth || first->height != kHeight)
    return failure(ErrorCode::kUnsupported, fmt::format("{}: depth = {} x {}, expected {} x {}", options_.folder, first->width, first->height, kWidth, kHeight));
  return {};
}

Result<void> FreenectSource::open() {
  close();
  if (auto usable = check(); !usable) return usable;
  auto camera = camera_for_image(options_.camera ? options_.camera->camera : centred_camera(options_.depth == "registered" ? kColorFocal_px : kInfraredFocal_px), kWidth, kHeight);
  if (!camera) return tl::unexpected<Error>(camera.error());
  camera_ = std::move(*camera);
  auto api = FreenectApi::load(options_.library, options_.folder);
  if (!api) return tl::unexpected<Error>(api.error());
  api_ = std::move(*api);
  auto opened = open_device().and_then([this] { return start(); });
  if (!opened) close();
  return opened;
}

Result<void> FreenectSource::open_device() {
  if (api_->init(&context_, nullptr) < 0) return context_ = nullptr, failure(ErrorCode::kDeviceLost, "libfreenect: USB cannot be used");
  api_->set_log_level(context_, FREENECT_LOG_FATAL);
  api_->select_subdevices(context_, static_cast<freenect_device_flags>(FREENECT_DEVICE_MOTOR | FREENECT_DEVICE_CAMERA));
  const int devices = api_->num_devices(context_);
  if (devices < 1) return failure(ErrorCode::kDeviceLost, "libfreenect: Kinects found = 0, expected at least 1");
  const bool first = options_.serial.empty();
  if ((first ? api_->open_device(context_, &device_, 0) : api_->open_device_by_camera_serial(context_, &device_, options_.serial.c_str())) < 0) {
    device_ = nullptr;
    return failure(ErrorCode::kDeviceLost, fmt::format("libfreenect: {} cannot be opened ({} found; in use, or not permitted: see the udev rules)",
                                                       first ? "the first Kinect" : "the Kinect of serial " + options_.serial, devices));
  }
  return {};
}

Result<void> FreenectSource::start() {
  const auto depth_format = options_.depth == "raw" ? FREENECT_DEPTH_11BIT : options_.depth == "mm" ? FREENECT_DEPTH_MM : FREENECT_DEPTH_REGISTERED;
  depth_ = Image<std::uint16_t>(kWidth, kHeight);
  color_ = Image<Rgb8>(kWidth, kHeight);
  depth_ticks_.reset();
  color_ticks_.reset();
  clock_ = {};
  session_.restart();
  take_calibration();
  api_->set_depth_callback(device_, depth_arrived);
  api_->set_video_callback(device_, video_arrived);
  api_->set_led(device_, led_of(options_.led));
  if (options_.move_tilt) api_->set_tilt_degs(device_, options_.tilt_rad * 180 / std::numbers::pi);
  bool started = api_->set_depth_mode(device_, api_->find_depth_mode(FREENECT_RESOLUTION_MEDIUM, depth_format)) >= 0 && api_->start_depth(device_) >= 0;
  if (options_.color) {
    started = started && api_->set_video_mode(device_, api_->find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB)) >= 0 && api_->start_video(device_) >= 0;
  }
  if (!started) return failure(ErrorCode::kDeviceLost, "libfreenect: the streams cannot be started");
  return {};
}

/// The device's own table where there is one (fakenect has none), else the configured line.
void FreenectSource::take_calibration() {
  table_ = kinect_depth_table(options_.calibration);
  if (!options_.device_calibration || api_->copy_registration == nullptr || api_->destroy_registration == nullptr) return;
  freenect_registration registration = api_->copy_registration(device_);
  if (registration.raw_to_mm_shift != nullptr) {
    const double units_per_mm = 1e-3 / kKinectDepthScale_m;
    for (std::size_t raw = 0; raw < kKinectNoReading; ++raw) table_[raw] = static_cast<std::uint16_t>(std::min(65535.0, registration.raw_to_mm_shift[raw] * units_per_mm));
    table_[kKinectNoReading] = 0;
  }
  api_->destroy_registration(&registration);
}

Result<Frame> FreenectSource::grab(std::chrono::milliseconds timeout) {
  if (api_ == nullptr) return failure(ErrorCode::kDeviceLost, "the Kinect is not open");
  const Nanoseconds deadline = monotonic_now() + timeout;
  processing = this;
  while (!depth_ticks_) {
    const auto left = std::chrono::duration_cast<std::chrono::microseconds>(deadline - monotonic_now());
    if (left.count() <= 0) return failure(ErrorCode::kTimeout, fmt::format("no depth frame within {} ms", timeout.count()));
    timeval slice{left.count() / 1'000'000, left.count() % 1'000'000};
    if (api_->process_events_timeout(context_, &slice) >= 0) continue;
    if (!options_.folder.empty()) return failure(ErrorCode::kEndOfStream, "the recorded folder has come to its end");
    return failure(ErrorCode::kDeviceLost, "the Kinect is gone");
  }
  return make_frame(session_.stamp(clock_.unwrap(*depth_ticks_)));
}

Frame FreenectSource::make_frame(Nanoseconds stamp) {
  Frame frame;
  frame.sensor = options_.sensor;
  frame.sequence = sequence_++;
  frame.stamps = {stamp, monotonic_now(), realtime_now()};
  frame.camera = camera_;
  frame.noise = options_.noise;
  if (options_.camera) frame.T_world_sensor = options_.camera->T_world_sensor;
  if (options_.depth == "raw") frame.depth = depth_of_raw(depth_, table_);
  else frame.depth = {depth_, 0.001};
  const std::int64_t lag_ticks = color_ticks_ ? static_cast<std::int32_t>(*depth_ticks_ - *color_ticks_) : 0;
  if (color_ticks_ && Nanoseconds(std::abs(lag_ticks) * 50 / 3) <= kMaxColorLag) {
    frame.color = options_.depth == "registered" ? color_ : register_color(frame.depth, camera_, color_, centred_camera(options_.color_focal_px), options_.color_offset_m);
  }
  depth_ticks_.reset();
  return frame;
}

void FreenectSource::close() noexcept {
  if (api_ == nullptr) return;
  processing = this;
  if (device_ != nullptr) {
    api_->stop_depth(device_);
    if (options_.color) api_->stop_video(device_);
    api_->close_device(device_);
    device_ = nullptr;
  }
  if (context_ != nullptr) api_->shutdown(context_);
  context_ = nullptr;
  api_.reset();
}

}  // namespace

std::unique_ptr<FrameSource> make_freenect_source(FreenectOptions options) { return std::make_unique<FreenectSource>(std::move(options)); }

Result<std::vector<std::string>> list_freenect_devices() {
  auto api = FreenectApi::load({}, {});
  if (!api) return tl::unexpected<Error>(api.error());
  freenect_context* context = nullptr;
  if ((*api)->init(&context, nullptr) < 0) return failure(ErrorCode::kIo, "libfreenect: USB cannot be used");
  (*api)->set_log_level(context, FREENECT_LOG_FATAL);
  std::vector<std::string> serials;
  freenect_device_attributes* list = nullptr;
  if ((*api)->list_device_attributes != nullptr && (*api)->free_device_attributes != nullptr && (*api)->list_device_attributes(context, &list) > 0) {
    for (const freenect_device_attributes* device = list; device != nullptr; device = device->next) serials.emplace_back(device->camera_serial);
    (*api)->free_device_attributes(list);
  }
  (*api)->shutdown(context);
  return serials;
}

}  // namespace gfp
