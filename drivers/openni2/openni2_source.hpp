#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gfp/frame/frame_source.hpp"
#include "openni2/openni2_options.hpp"

namespace gfp {

/// A device that OpenNI2 has a driver for, or an .oni file. One thread at a time.
///
/// Depth in whole millimetres; where the device can, depth is registered to colour, and the camera then is the colour camera's as
/// far as OpenNI2 tells it: the fields of view. Mirrored streams are turned back. Colour is the latest within 50 ms.
/// A file delivers every frame it says it has, from `first_frame` on, fewer only where it ends before; decoding one may outlast a grab's timeout.
/// With `record`, open() returns when the recorder records.
/// open() errors: kDeviceLost (no such device), kUnsupported (no library), kNotFound and kCorruptData (a file), kInvalidArgument.
/// grab() errors: kTimeout, kDeviceLost, kCorruptFrame (of another size than the stream's; frames of a file are missing), kEndOfStream.
std::unique_ptr<FrameSource> make_openni2_source(OpenNi2Options options);

struct OpenNi2Device {
  std::string uri, vendor, name;
};

/// The devices that OpenNI2's drivers report. Errors: kUnsupported, kIo, as OpenNi2Api::acquire().
Result<std::vector<OpenNi2Device>> list_openni2_devices(const std::string& library = OpenNi2Options{}.library);

}  // namespace gfp
