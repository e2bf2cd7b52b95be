#include "bumblebee/fake/fake_bumblebee.hpp"

extern "C" {
#include <arv.h>
}
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstring>

namespace gfp {

struct FakeBumblebee::Show {
  std::vector<std::vector<std::uint8_t>> pictures;  ///< Interleaved.
  std::atomic<std::uint64_t> next{0};
  ArvGvFakeCamera* camera = nullptr;
};

namespace {

/// Called by the camera's thread for each frame. The buffer does not tell its size here; it is that of the registers, which are ours.
void fill(ArvBuffer* buffer, void* data, guint32, guint32, ArvPixelFormat) {
  auto& show = *static_cast<FakeBumblebee::Show*>(data);
  std::size_t unknown = 0;
  auto* const to = const_cast<void*>(arv_buffer_get_data(buffer, &unknown));
  const auto& picture = show.pictures[show.next++ % show.pictures.size()];
  std::memcpy(to, picture.data(), picture.size());
}

std::vector<std::uint8_t> interleaved(const StereoPair& pair) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * pair.left.pixels.size());
  for (std::size_t i = 0; i < pair.left.pixels.size(); ++i) {
    bytes.push_back(pair.right.pixels[i]);
    bytes.push_back(pair.left.pixels[i]);
  }
  return bytes;
}

}  // namespace

FakeBumblebee::FakeBumblebee() : show_(std::make_unique<Show>()) {}

std::uint64_t FakeBumblebee::sent() const { return show_->next; }

FakeBumblebee::~FakeBumblebee() { g_clear_object(&show_->camera); }

Result<std::unique_ptr<FakeBumblebee>> FakeBumblebee::start(const std::vector<StereoPair>& pairs, const FakeBumblebeeOptions& options) {
  if (pairs.empty()) return failure(ErrorCode::kInvalidArgument, "fake bumblebee: no pictures");
  const int width = pairs.front().left.width, height = pairs.front().left.height;
  std::unique_ptr<FakeBumblebee> fake(new FakeBumblebee);
  for (const StereoPair& pair : pairs) {
    if (pair.left.width != width || pair.left.height != height || pair.right.width != width || pair.right.height != height)
      return failure(ErrorCode::kInvalidArgument, "fake bumblebee: pictures of different sizes");
    fake->show_->pictures.push_back(interleaved(pair));
  }
  ArvGvFakeCamera* const camera = arv_gv_fake_camera_new(options.address.c_str(), options.serial.c_str());
  fake->show_->camera = camera;
  if (camera == nullptr || !arv_gv_fake_camera_is_running(camera)) return failure(ErrorCode::kIo, fmt::format("fake bumblebee: {} port 3956 cannot be had", options.address));
  ArvFakeCamera* const registers = arv_gv_fake_camera_get_fake_camera(camera);
  arv_fake_camera_set_fill_pattern(registers, fill, fake->show_.get());
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, static_cast<guint32>(width));
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, static_cast<guint32>(height));
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_WIDTH, static_cast<guint32>(width));
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_HEIGHT, static_cast<guint32>(height));
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, ARV_PIXEL_FORMAT_MONO_16);
  arv_fake_camera_write_register(registers, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, static_cast<guint32>(std::lround(1e6 / options.rate_hz)));
  g_object_set(camera, "gvsp-lost-ratio", options.lost_packets, nullptr);
  return fake;
}

}  // namespace gfp
