#pragma once

#include <OniCAPI.h>
#include <OniCProperties.h>

#include <memory>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// OpenNI2's C functions, found at run time, between its initialisation and its shutdown. One is shared by all sources of a
/// process, since OpenNI2 is one per process; the last owner shuts it down, so it must outlive every device.
class OpenNi2Api {
 public:
  /// Errors: kUnsupported (no such library, a missing function, another library is in use), kIo (no drivers).
  static Result<std::shared_ptr<OpenNi2Api>> acquire(const std::string& library);
  ~OpenNi2Api();
  OpenNi2Api(const OpenNi2Api&) = delete;
  OpenNi2Api& operator=(const OpenNi2Api&) = delete;

  /// The library's own words on the last failure.
  std::string why() const;

#define GFP_OPENNI2_FUNCTIONS(X)                                                                                           \
  X(Initialize) X(Shutdown) X(GetDeviceList) X(ReleaseDeviceList) X(RegisterDeviceCallbacks) X(UnregisterDeviceCallbacks)  \
  X(WaitForAnyStream) X(GetExtendedError) X(DeviceOpen) X(DeviceClose) X(DeviceGetInfo) X(DeviceCreateStream)              \
  X(DeviceSetProperty) X(DeviceIsImageRegistrationModeSupported) X(StreamDestroy) X(StreamStart) X(StreamStop)             \
  X(StreamReadFrame) X(StreamSetProperty) X(StreamGetProperty) X(FrameRelease) X(CreateRecorder) X(RecorderAttachStream)   \
  X(RecorderStart) X(RecorderStop) X(RecorderDestroy)
#define GFP_OPENNI2_POINTER(name) decltype(&::oni##name) name = nullptr;
  GFP_OPENNI2_FUNCTIONS(GFP_OPENNI2_POINTER)
#undef GFP_OPENNI2_POINTER

 private:
  OpenNi2Api() = default;
  Result<void> load(const std::string& library);

  std::string name_;
  void* library_ = nullptr;
  bool initialised_ = false;
};

}  // namespace gfp
