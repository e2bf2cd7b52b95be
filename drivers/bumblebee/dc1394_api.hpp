#pragma once

#include <dc1394/dc1394.h>

#include <memory>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// libdc1394's functions, found at run time: programs start without it. Unloaded with it.
class Dc1394Api {
 public:
  /// Errors: kUnsupported (no such library, a missing function).
  static Result<std::unique_ptr<Dc1394Api>> load(const std::string& library);
  ~Dc1394Api();
  Dc1394Api(const Dc1394Api&) = delete;
  Dc1394Api& operator=(const Dc1394Api&) = delete;

#define GFP_DC1394_FUNCTIONS(X)                                                                                                   \
  X(new) X(free) X(camera_enumerate) X(camera_free_list) X(camera_new) X(camera_free) X(error_get_string)                         \
  X(video_set_operation_mode) X(video_set_iso_speed) X(video_set_mode) X(video_set_transmission) X(format7_get_max_image_size)    \
  X(format7_set_roi) X(feature_set_absolute_control) X(feature_set_absolute_value) X(capture_setup) X(capture_stop)               \
  X(capture_dequeue) X(capture_enqueue) X(capture_get_fileno) X(capture_is_frame_corrupt)
#define GFP_DC1394_POINTER(name) decltype(&::dc1394_##name) name##_ = nullptr;
  GFP_DC1394_FUNCTIONS(GFP_DC1394_POINTER)
#undef GFP_DC1394_POINTER

 private:
  Dc1394Api() = default;
  void* library_ = nullptr;
};

}  // namespace gfp
