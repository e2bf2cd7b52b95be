#pragma once

#include <libfreenect.h>
#include <libfreenect_registration.h>

#include <filesystem>
#include <memory>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// libfreenect's functions, found at run time: the program starts without the library, fakenect can take its place, and what
/// fakenect lacks is a null pointer instead of a symbol error in the middle of the work. Unloads it when destroyed, which is also
/// the only way to rewind fakenect.
class FreenectApi {
 public:
  /// `library` empty: libfreenect.so.0.5, or fakenect's beside it where a folder is to be played.
  /// fakenect takes its folder from the environment and keeps its place in global variables, so one folder plays at a time.
  /// Errors: kUnsupported (no such library, a required function is missing, a second folder).
  static Result<std::unique_ptr<FreenectApi>> load(const std::string& library, const std::filesystem::path& folder);
  ~FreenectApi();
  FreenectApi(const FreenectApi&) = delete;
  FreenectApi& operator=(const FreenectApi&) = delete;

#define GFP_FREENECT_REQUIRED(X)                                                                                          \
  X(init) X(shutdown) X(set_log_level) X(process_events_timeout) X(num_devices) X(select_subdevices) X(open_device)       \
  X(open_device_by_camera_serial) X(close_device) X(set_depth_callback) X(set_video_callback)     \
  X(start_depth) X(start_video) X(stop_depth) X(stop_video) X(find_depth_mode) X(find_video_mode) X(set_depth_mode)       \
  X(set_video_mode) X(set_led) X(set_tilt_degs)
#define GFP_FREENECT_OPTIONAL(X) X(list_device_attributes) X(free_device_attributes) X(copy_registration) X(destroy_registration)
#define GFP_FREENECT_POINTER(name) decltype(&::freenect_##name) name = nullptr;
  GFP_FREENECT_REQUIRED(GFP_FREENECT_POINTER)
  GFP_FREENECT_OPTIONAL(GFP_FREENECT_POINTER)
#undef GFP_FREENECT_POINTER

 private:
  FreenectApi() = default;

  void* library_ = nullptr;
  bool plays_folder_ = false;
};

}  // namespace gfp
