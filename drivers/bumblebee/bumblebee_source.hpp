#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bumblebee/bumblebee_options.hpp"
#include "gfp/core/error.hpp"
#include "gfp/frame/frame_source.hpp"
#include "gfp/frame/stereo_pair.hpp"

namespace gfp {

/// A stereo camera through Aravis (GigE Vision, USB3 Vision): Bumblebee X and others that deliver both eyes in one transfer, or two cameras.
/// `to_frame` turns a pair into depth, on the thread that grabs. grab() errors: kTimeout, kCorruptFrame (incomplete, or of another size), kDeviceLost.
/// open() errors: kDeviceLost, kUnsupported (a refused setting), kInvalidArgument (`two_devices` without two names).
std::unique_ptr<FrameSource> make_bumblebee_source(BumblebeeOptions options, StereoToFrame to_frame);

/// Cameras that answer, as BumblebeeOptions::device names them.
struct BumblebeeDevice {
  std::string id, model, serial;
};
std::vector<BumblebeeDevice> list_bumblebee_devices();

}  // namespace gfp
