// An OpenNI2 driver that serves the synthetic source: what talks to OpenNI2 can be tried without hardware.
//
//   device "gfp-synthetic", or "gfp-synthetic:seed=3,objects=4,rate_hz=30,unplug_after=10" (opened by that name)
//   one thread a device renders a frame and gives it to each stream that was started
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <thread>

// OpenNI2's own library of helpers is not shipped; its driver header wants these two of it.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>

#include "gfp/core/mutex.hpp"
#include "synthetic/synthetic_source.hpp"

namespace {

using gfp::Frame;
using gfp::Rgb8;

constexpr const char* kUri = "gfp-synthetic";
constexpr int kWidth = 640, kHeight = 480;

struct DeviceOptions {
  gfp::SyntheticOptions synthetic;
  std::uint64_t unplug_after = 0;  ///< Frames; 0: it stays.
};

template <class Value>
bool parse(std::string_view text, Value& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// "gfp-synthetic:key=value,...": false where that is no device of ours.
bool parse_uri(std::string_view uri, DeviceOptions& options) {
  if (!uri.starts_with(kUri)) return false;
  uri.remove_prefix(std::string_view(kUri).size());
  if (uri.empty()) return true;
  if (uri[0] != ':') return false;
  uri.remove_prefix(1);
  while (!uri.empty()) {
    const std::string_view pair = uri.substr(0, uri.find(','));
    uri.remove_prefix(std::min(uri.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos) return false;
    const std::string_view key = pair.substr(0, equals), value = pair.substr(equals + 1);
    const bool known = key == "seed"           ? parse(value, options.synthetic.seed)
                       : key == "objects"      ? parse(value, options.synthetic.table.objects)
                       : key == "rate_hz"      ? parse(value, options.synthetic.rate_hz)
                       : key == "unplug_after" ? parse(value, options.unplug_after)
                                               : false;
    if (!known) return false;
  }
  return true;
}

template <class Value>
OniStatus answer(const Value& value, void* data, int* bytes) {
  if (*bytes < static_cast<int>(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(Value));
  *bytes = sizeof(Value);
  return ONI_STATUS_OK;
}

OniVideoMode video_mode(OniSensorType sensor) { return {sensor == ONI_SENSOR_DEPTH ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888, kWidth, kHeight, 30}; }

class Device;

/// Depth or colour of a device. start() and stop() come from the application's threads, give() from the device's.
class Stream final : public oni::driver::StreamBase {
 public:
  Stream(Device& device, OniSensorType sensor) : device_(device), sensor_(sensor) {}

  OniStatus start() override;
  void stop() override;
  OniStatus getProperty(int id, void* data, int* bytes) override;
  OniStatus setProperty(int id, const void* data, int bytes) override;
  OniBool isPropertySupported(int id) override;
  void give(const Frame& frame);

 private:
  void fill(const Frame& frame, OniFrame& out) const;

  Device& device_;
  const OniSensorType sensor_;
  gfp::Mutex mutex_;
  bool running_ GFP_GUARDED_BY(mutex_) = false;
  int frame_index_ GFP_GUARDED_BY(mutex_) = 0;
};

class Driver;

class Device final : public oni::driver::DeviceBase {
 public:
  Device(Driver& driver, const OniDeviceInfo& info, const DeviceOptions& options) : driver_(driver), info_(info), options_(options) {
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      modes_[i] = video_mode(kSensors[i]);
      sensors_[i] = {kSensors[i], 1, &modes_[i]};
    }
  }
  ~Device() override { thread_ = {}; }

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_.data();
    *count = static_cast<int>(sensors_.size());
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType sensor) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniStatus getProperty(int id, void* data, int* bytes) override {
    if (id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return answer(ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR, data, bytes);
    return ONI_STATUS_NOT_SUPPORTED;
  }
  OniStatus setProperty(int id, const void*, int) override { return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED; }
  OniBool isPropertySupported(int id) override { return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ? TRUE : FALSE; }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

  void start();  ///< Of the first stream.

 private:
  static constexpr std::array<OniSensorType, 2> kSensors{ONI_SENSOR_DEPTH, ONI_SENSOR_COLOR};

  void run(const std::stop_token& stop);

  Driver& driver_;
  const OniDeviceInfo info_;
  const DeviceOptions options_;
  std::array<OniVideoMode, 2> modes_{};
  std::array<OniSensorInfo, 2> sensors_{};
  gfp::Mutex mutex_;
  /// Shared with the thread that renders: a stream may be destroyed while a frame is on its way to it.
  std::array<std::shared_ptr<Stream>, 2> streams_ GFP_GUARDED_BY(mutex_){};
  bool started_ GFP_GUARDED_BY(mutex_) = false;
  std::jthread thread_;
};

class Driver final : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected, oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    const OniStatus status = DriverBase::initialize(connected, disconnected, changed, cookie);
    if (status == ONI_STATUS_OK) plug_in(kUri);
    return status;
  }
  OniStatus tryDevice(const char* uri) override {
    DeviceOptions options;
    if (!parse_uri(uri, options)) return ONI_STATUS_ERROR;
    plug_in(uri);
    return ONI_STATUS_OK;
  }
  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
    DeviceOptions options;
    return parse_uri(uri, options) ? new Device(*this, info_of(uri), options) : nullptr;
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  void shutdown() override {}

  void unplug(const OniDeviceInfo& info) { deviceDisconnected(&info); }

 private:
  static OniDeviceInfo info_of(const char* uri) {
    OniDeviceInfo info{};
    std::strncpy(info.uri, uri, sizeof(info.uri) - 1);
    std::strcpy(info.vendor, "gfp");
    std::strcpy(info.name, "virtual Kinect");
    return info;
  }
  void plug_in(const char* uri) {
    const OniDeviceInfo info = info_of(uri);
    deviceConnected(&info);
  }
};

OniStatus Stream::start() {
  {
    gfp::MutexLock lock(mutex_);
    running_ = true;
  }
  device_.start();
  return ONI_STATUS_OK;
}

void Stream::stop() {
  gfp::MutexLock lock(mutex_);
  running_ = false;
}

OniStatus Stream::getProperty(int id, void* data, int* bytes) {
  const gfp::CameraModel camera = gfp::default_kinect_camera(kWidth, kHeight);
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE: return answer(video_mode(sensor_), data, bytes);
    case ONI_STREAM_PROPERTY_CROPPING: return answer(OniCropping{FALSE, 0, 0, 0, 0}, data, bytes);  // without it, recordings are empty
    case ONI_STREAM_PROPERTY_MIRRORING: return answer(OniBool{FALSE}, data, bytes);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV: return answer(static_cast<float>(2 * std::atan(0.5 * kWidth / camera.fx)), data, bytes);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV: return answer(static_cast<float>(2 * std::atan(0.5 * kHeight / camera.fy)), data, bytes);
    case ONI_STREAM_PROPERTY_MIN_VALUE: return answer(0, data, bytes);
    case ONI_STREAM_PROPERTY_MAX_VALUE: return answer(10000, data, bytes);
    default: return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus Stream::setProperty(int id, const void* data, int bytes) {
  if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && bytes == sizeof(OniVideoMode)) {
    const OniVideoMode only = video_mode(sensor_);
    OniVideoMode wanted;
    std::memcpy(&wanted, data, sizeof(wanted));
    const bool same = wanted.pixelFormat == only.pixelFormat && wanted.resolutionX == only.resolutionX && wanted.resolutionY == only.resolutionY;
    return same ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  return id == ONI_STREAM_PROPERTY_MIRRORING ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
}

OniBool Stream::isPropertySupported(int id) {
  return id >= ONI_STREAM_PROPERTY_CROPPING && id <= ONI_STREAM_PROPERTY_MIRRORING && id != ONI_STREAM_PROPERTY_STRIDE ? TRUE : FALSE;
}

void Stream::fill(const Frame& frame, OniFrame& out) const {
  const bool is_depth = sensor_ == ONI_SENSOR_DEPTH;
  out.sensorType = sensor_;
  out.videoMode = video_mode(sensor_);
  out.width = kWidth;
  out.height = kHeight;
  out.stride = kWidth * (is_depth ? 2 : 3);
  out.dataSize = out.stride * kHeight;
  out.croppingEnabled = FALSE;
  out.cropOriginX = out.cropOriginY = 0;
  out.timestamp = static_cast<std::uint64_t>(frame.stamps.sensor.count() / 1000);
  if (!is_depth) {
    std::memcpy(out.data, frame.color.pixels.data(), static_cast<std::size_t>(out.dataSize));
    return;
  }
  auto* mm = static_cast<std::uint16_t*>(out.data);
  const double mm_per_unit = 1000 * frame.depth.scale_m;
  for (const std::uint16_t pixel : frame.depth.pixels.pixels) *mm++ = static_cast<std::uint16_t>(pixel * mm_per_unit + 0.5);
}

void Stream::give(const Frame& frame) {
  gfp::MutexLock lock(mutex_);
  if (!running_) return;
  OniFrame* out = getServices().acquireFrame();
  if (out == nullptr) return;
  fill(frame, *out);
  out->frameIndex = ++frame_index_;
  raiseNewFrame(out);
  getServices().releaseFrame(out);
}

oni::driver::StreamBase* Device::createStream(OniSensorType sensor) {
  const auto place = std::find(kSensors.begin(), kSensors.end(), sensor);
  if (place == kSensors.end()) return nullptr;
  auto stream = std::make_shared<Stream>(*this, sensor);
  gfp::MutexLock lock(mutex_);
  streams_[static_cast<std::size_t>(place - kSensors.begin())] = stream;
  return stream.get();
}

void Device::destroyStream(oni::driver::StreamBase* stream) {
  static_cast<Stream*>(stream)->stop();
  gfp::MutexLock lock(mutex_);
  for (auto& known : streams_)
    if (known.get() == stream) known.reset();
}

void Device::start() {
  gfp::MutexLock lock(mutex_);
  if (std::exchange(started_, true)) return;
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Device::run(const std::stop_token& stop) {
  gfp::SyntheticSource source(options_.synthetic);
  if (!source.open()) return;
  for (std::uint64_t delivered = 0; !stop.stop_requested();) {
    const auto frame = source.grab(std::chrono::milliseconds(100));
    if (!frame) continue;
    std::array<std::shared_ptr<Stream>, 2> streams;  // no lock of ours is held while OpenNI2 takes its own
    {
      gfp::MutexLock lock(mutex_);
      streams = streams_;
    }
    for (const auto& stream : {streams[1], streams[0]})  // colour first: it belongs to the depth that follows
      if (stream) stream->give(*frame);
    if (++delivered == options_.unplug_after) return driver_.unplug(info_);
  }
}

}  // namespace

ONI_EXPORT_DRIVER(Driver)
