// A libdc1394 without a bus: two cameras, a Bumblebee2 and an XB3, whose pictures tell their number. Every fifth one is corrupt, after the twelfth the camera
// is gone, until it is opened anew. One instance at a time.
#include <dc1394/dc1394.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace {

constexpr std::uint64_t kGuids[] = {0x00b09d0100000002, 0x00b09d0100000003};
constexpr std::uint32_t kWidth = 64, kHeight = 48, kPadding = 16, kGoneAfter = 12, kCorruptEvery = 5;

struct State {
  dc1394camera_t camera{};
  char model[32] = {};
  char vendor[32] = "Point Grey Research";
  std::uint32_t bytes_per_pixel = 0, pictures = 0;
  bool transmits = false;
  int ready = -1;
  std::vector<unsigned char> bytes;
  dc1394video_frame_t frame{};
} state;

}  // namespace

extern "C" {

dc1394_t* dc1394_new(void) { return reinterpret_cast<dc1394_t*>(&state); }
void dc1394_free(dc1394_t*) {}
const char* dc1394_error_get_string(dc1394error_t error) { return error == DC1394_SUCCESS ? "success" : "fake failure"; }

dc1394error_t dc1394_camera_enumerate(dc1394_t*, dc1394camera_list_t** list) {
  static dc1394camera_id_t ids[2] = {{0, kGuids[0]}, {0, kGuids[1]}};
  static dc1394camera_list_t all = {2, ids};
  *list = &all;
  return DC1394_SUCCESS;
}
void dc1394_camera_free_list(dc1394camera_list_t*) {}

dc1394camera_t* dc1394_camera_new(dc1394_t*, std::uint64_t guid) {
  state.camera = {};
  state.camera.guid = guid;
  std::strcpy(state.model, guid == kGuids[1] ? "Bumblebee XB3" : "Bumblebee2");
  state.camera.vendor = state.vendor;
  state.camera.model = state.model;
  state.camera.bmode_capable = guid == kGuids[1] ? DC1394_TRUE : DC1394_FALSE;
  state.pictures = 0;
  return &state.camera;
}
void dc1394_camera_free(dc1394camera_t*) {}

dc1394error_t dc1394_video_set_operation_mode(dc1394camera_t*, dc1394operation_mode_t) { return DC1394_SUCCESS; }
dc1394error_t dc1394_video_set_iso_speed(dc1394camera_t* camera, dc1394speed_t speed) {
  return speed == DC1394_ISO_SPEED_800 && camera->bmode_capable == DC1394_FALSE ? DC1394_FAILURE : DC1394_SUCCESS;
}
dc1394error_t dc1394_video_set_mode(dc1394camera_t*, dc1394video_mode_t mode) { return mode == DC1394_VIDEO_MODE_FORMAT7_3 ? DC1394_SUCCESS : DC1394_FAILURE; }
dc1394error_t dc1394_video_set_transmission(dc1394camera_t*, dc1394switch_t power) { return state.transmits = power == DC1394_ON, DC1394_SUCCESS; }
dc1394error_t dc1394_format7_get_max_image_size(dc1394camera_t*, dc1394video_mode_t, std::uint32_t* width, std::uint32_t* height) { return *width = kWidth, *height = kHeight, DC1394_SUCCESS; }
dc1394error_t dc1394_format7_set_roi(dc1394camera_t* camera, dc1394video_mode_t, dc1394color_coding_t coding, std::int32_t, std::int32_t, std::int32_t, std::int32_t, std::int32_t) {
  const bool three = camera->guid == kGuids[1];
  if (three != (coding == DC1394_COLOR_CODING_RGB8)) return DC1394_FAILURE;
  return state.bytes_per_pixel = three ? 3 : 2, DC1394_SUCCESS;
}
dc1394error_t dc1394_feature_set_absolute_control(dc1394camera_t*, dc1394feature_t, dc1394switch_t) { return DC1394_SUCCESS; }
dc1394error_t dc1394_feature_set_absolute_value(dc1394camera_t*, dc1394feature_t, float value) { return value > 0.06F ? DC1394_FAILURE : DC1394_SUCCESS; }

dc1394error_t dc1394_capture_setup(dc1394camera_t*, std::uint32_t, std::uint32_t) { return state.ready = eventfd(1, EFD_CLOEXEC), DC1394_SUCCESS; }
dc1394error_t dc1394_capture_stop(dc1394camera_t*) { return close(state.ready), DC1394_SUCCESS; }
int dc1394_capture_get_fileno(dc1394camera_t*) { return state.ready; }
dc1394error_t dc1394_capture_enqueue(dc1394camera_t*, dc1394video_frame_t*) { return DC1394_SUCCESS; }
dc1394bool_t dc1394_capture_is_frame_corrupt(dc1394camera_t*, dc1394video_frame_t*) { return state.pictures % kCorruptEvery == 0 ? DC1394_TRUE : DC1394_FALSE; }

dc1394error_t dc1394_capture_dequeue(dc1394camera_t*, dc1394capture_policy_t, dc1394video_frame_t** frame) {
  *frame = nullptr;
  if (!state.transmits || state.pictures >= kGoneAfter) return DC1394_FAILURE;
  ++state.pictures;
  const std::uint32_t stride = kWidth * state.bytes_per_pixel + kPadding;
  state.bytes.assign(std::size_t{stride} * kHeight, 255);
  for (std::uint32_t v = 0; v < kHeight; ++v)
    for (std::uint32_t i = 0; i < kWidth * state.bytes_per_pixel; ++i) state.bytes[v * stride + i] = static_cast<unsigned char>(60 * (i % state.bytes_per_pixel) + state.pictures);
  state.frame = {};
  state.frame.image = state.bytes.data();
  state.frame.size[0] = kWidth;
  state.frame.size[1] = kHeight;
  state.frame.stride = stride;
  state.frame.total_bytes = state.bytes.size();
  state.frame.timestamp = 1'000'000 + 33'000ULL * state.pictures;
  *frame = &state.frame;
  return DC1394_SUCCESS;
}
}
