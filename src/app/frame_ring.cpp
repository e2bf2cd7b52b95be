#include "app/frame_ring.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

namespace gfp {
namespace {

constexpr std::size_t kMaxCoefficients = 14;

/// A frame without its pixels. Plain numbers only: it is read from memory that another process writes.
struct Header {
  std::uint64_t sequence;
  std::int64_t sensor_ns, monotonic_ns, realtime_ns;
  std::int32_t width, height, color_width, color_height;
  double depth_scale_m;
  std::int32_t camera_width, camera_height, distortion, coefficient_count;
  std::array<double, 4> focal_centre;
  std::array<double, kMaxCoefficients> coefficients;
  std::array<double, 3> noise;
  std::array<double, 16> T_world_sensor;
  std::int32_t has_up, padding;
  std::array<double, 3> up_camera;
};

struct Slot {
  std::atomic<std::uint64_t> version;  ///< 2 turn + 2 when turn `turn` is complete, odd while it is written.
  Header header;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

constexpr std::size_t kHeaderBytes = 4096;
constexpr std::size_t kSlotBytes = kHeaderBytes + FrameRing::kMaxPixels * (sizeof(std::uint16_t) + sizeof(Rgb8));
static_assert(sizeof(Slot) <= kHeaderBytes && kSlotBytes % kHeaderBytes == 0);

Header header_of(const Frame& frame) {
  Header h{};
  h.sequence = frame.sequence;
  h.sensor_ns = frame.stamps.sensor.count(), h.monotonic_ns = frame.stamps.monotonic.count(), h.realtime_ns = frame.stamps.realtime.count();
  h.width = frame.depth.pixels.width, h.height = frame.depth.pixels.height;
  h.color_width = frame.color.width, h.color_height = frame.color.height;
  h.depth_scale_m = frame.depth.scale_m;
  h.camera_width = frame.camera.width, h.camera_height = frame.camera.height;
  h.focal_centre = {frame.camera.fx, frame.camera.fy, frame.camera.cx, frame.camera.cy};
  h.distortion = static_cast<std::int32_t>(frame.camera.distortion);
  h.coefficient_count = static_cast<std::int32_t>(std::min(kMaxCoefficients, frame.camera.coefficients.size()));
  std::copy_n(frame.camera.coefficients.begin(), h.coefficient_count, h.coefficients.begin());
  h.noise = {frame.noise.base_m, frame.noise.quadratic_per_m, frame.noise.reference_m};
  Eigen::Map<Eigen::Matrix4d>(h.T_world_sensor.data()) = frame.T_world_sensor.matrix();
  h.has_up = frame.up_camera ? 1 : 0;
  if (frame.up_camera) Eigen::Map<Eigen::Vector3d>(h.up_camera.data()) = *frame.up_camera;
  return h;
}

bool is_size(std::int32_t width, std::int32_t height) {
  return width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide && static_cast<std::size_t>(width) * static_cast<std::size_t>(height) <= FrameRing::kMaxPixels;
}

template <std::size_t N>
bool all_finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

bool is_sound(const Header& h) {
  const bool color = (h.color_width == 0 && h.color_height == 0) || is_size(h.color_width, h.color_height);
  return is_size(h.width, h.height) && color && h.depth_scale_m > 0 && std::isfinite(h.depth_scale_m) && h.distortion >= 0 && h.distortion <= 2 && h.coefficient_count >= 0 &&
         h.coefficient_count <= static_cast<std::int32_t>(kMaxCoefficients) && all_finite(h.coefficients) && all_finite(h.noise) && all_finite(h.T_world_sensor) && all_finite(h.up_camera);
}

Frame frame_of(const Header& h) {
  Frame frame;
  frame.sequence = h.sequence;
  frame.stamps = {Nanoseconds(h.sensor_ns), Nanoseconds(h.monotonic_ns), Nanoseconds(h.realtime_ns)};
  frame.depth = {Image<std::uint16_t>(h.width, h.height), h.depth_scale_m};
  if (h.color_width > 0) frame.color = Image<Rgb8>(h.color_width, h.color_height);
  frame.camera = {h.camera_width, h.camera_height, h.focal_centre[0], h.focal_centre[1], h.focal_centre[2], h.focal_centre[3], static_cast<DistortionModel>(h.distortion),
                  {h.coefficients.begin(), h.coefficients.begin() + h.coefficient_count}};
  frame.noise = {h.noise[0], h.noise[1], h.noise[2]};
  frame.T_world_sensor.matrix() = Eigen::Map<const Eigen::Matrix4d>(h.T_world_sensor.data());
  if (h.has_up != 0) frame.up_camera = Eigen::Map<const Eigen::Vector3d>(h.up_camera.data());
  return frame;
}

Result<int> io_error(const char* what) { return failure(ErrorCode::kIo, fmt::format("shared memory: {}: {}", what, std::strerror(errno))); }

}  // namespace

Result<int> FrameRing::create() {
  const int descriptor = memfd_create("gfp-frames", MFD_CLOEXEC);
  if (descriptor < 0) return io_error("cannot be created");
  if (ftruncate(descriptor, static_cast<off_t>(kSlots * kSlotBytes)) == 0) return descriptor;
  const auto error = io_error("cannot be sized");
  ::close(descriptor);
  return error;
}

Result<FrameRing> FrameRing::map(int descriptor, bool writable) {
  struct stat status{};
  if (fstat(descriptor, &status) != 0 || status.st_size != static_cast<off_t>(kSlots * kSlotBytes)) return failure(ErrorCode::kIo, "shared memory: not a ring of frames");
  void* const memory = mmap(nullptr, kSlots * kSlotBytes, writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) return tl::unexpected<Error>(io_error("cannot be mapped").error());
  return FrameRing(memory);
}

FrameRing::~FrameRing() {
  if (memory_ != nullptr) munmap(memory_, kSlots * kSlotBytes);
}

std::byte* FrameRing::slot(std::uint64_t turn) const { return static_cast<std::byte*>(memory_) + (turn % kSlots) * kSlotBytes; }

Result<void> FrameRing::write(std::uint64_t turn, const Frame& frame) {
  if (frame.depth.pixels.pixels.size() > kMaxPixels || frame.color.pixels.size() > kMaxPixels)
    return failure(ErrorCode::kTooLarge, fmt::format("frame is {} x {} pixels, expected at most {} of them", frame.depth.pixels.width, frame.depth.pixels.height, kMaxPixels));
  std::byte* const at = slot(turn);
  auto& shared = *reinterpret_cast<Slot*>(at);
  shared.version.store(2 * turn + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  shared.header = header_of(frame);
  std::memcpy(at + kHeaderBytes, frame.depth.pixels.pixels.data(), sizeof(std::uint16_t) * frame.depth.pixels.pixels.size());
  std::memcpy(at + kHeaderBytes + sizeof(std::uint16_t) * kMaxPixels, frame.color.pixels.data(), sizeof(Rgb8) * frame.color.pixels.size());
  shared.version.store(2 * turn + 2, std::memory_order_release);
  return {};
}

Result<Frame> FrameRing::read(std::uint64_t turn) const {
  const std::byte* const at = slot(turn);
  const auto& shared = *reinterpret_cast<const Slot*>(at);
  const auto overwritten = [] { return failure(ErrorCode::kTimeout, "the frame was overwritten by a newer one"); };
  if (shared.version.load(std::memory_order_acquire) != 2 * turn + 2) return overwritten();
  Header header;
  std::memcpy(&header, &shared.header, sizeof(Header));  // a copy: what was checked cannot change any more
  if (!is_sound(header)) return failure(ErrorCode::kCorruptFrame, "the driver's process wrote what is no frame");
  Frame frame = frame_of(header);
  std::memcpy(frame.depth.pixels.pixels.data(), at + kHeaderBytes, sizeof(std::uint16_t) * frame.depth.pixels.pixels.size());
  std::memcpy(frame.color.pixels.data(), at + kHeaderBytes + sizeof(std::uint16_t) * kMaxPixels, sizeof(Rgb8) * frame.color.pixels.size());
  std::atomic_thread_fence(std::memory_order_acquire);
  if (shared.version.load(std::memory_order_relaxed) != 2 * turn + 2) return overwritten();
  if (const auto valid = validate(frame.camera); !valid) return failure(ErrorCode::kCorruptFrame, valid.error().what);
  return frame;
}

}  // namespace gfp
