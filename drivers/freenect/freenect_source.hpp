#pragma once

#include <memory>
#include <string>
#include <vector>

#include "freenect/freenect_options.hpp"
#include "gfp/frame/frame_source.hpp"

namespace gfp {

/// A Kinect v1 through libfreenect, or a recorded folder through fakenect, which stands in for it. One thread at a time.
///
/// Frames are 640 x 480, 30 Hz; depth from 0.4 m. Colour is registered to depth; it is the latest picture within 50 ms.
/// Stamps are the device's clock, unwrapped, from 0 at the first frame.
/// open() errors: kDeviceLost (no device, or none of that serial), kUnsupported (no library), kInvalidArgument (fakenect only
/// knows raw depth), and what list_fakenect_folder() says of a folder, since fakenect ends the process over a missing file.
/// grab() errors: kTimeout, kDeviceLost; kEndOfStream after a folder's last frame.
std::unique_ptr<FrameSource> make_freenect_source(FreenectOptions options);

/// Serial numbers of the Kinects that are plugged in. Errors: kUnsupported (no library), kIo (no USB).
Result<std::vector<std::string>> list_freenect_devices();

}  // namespace gfp
