#include "app/make_source.hpp"

#include <fmt/format.h>

#include "app/isolated_source.hpp"
#include "config/camera_file.hpp"
#include "config/stereo_calibration_file.hpp"
#ifdef GFP_HAS_BUMBLEBEE
#include "bumblebee/bumblebee_source.hpp"
#endif
#ifdef GFP_HAS_FREENECT
#include "freenect/freenect_source.hpp"
#endif
#ifdef GFP_HAS_OPENNI2
#include "openni2/openni2_source.hpp"
#endif
#include "gfp/cloud/rectify_stereo.hpp"
#include "replay/mcap_source.hpp"
#include "replay/replay_source.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

/// Fills in what a sensor says beside its driver's section: its name, and its camera where one is given.
template <class Options>
Result<Options> common_options(const SensorConfig& sensor, Options options) {
  options.sensor = sensor.name;
  if (sensor.camera.empty()) return options;
  auto camera = config::load_camera(sensor.camera);
  if (!camera) return tl::unexpected(camera.error());
  options.camera = std::move(*camera);
  return options;
}

Result<std::unique_ptr<FrameSource>> make_replay(const SensorConfig& sensor) {
  if (sensor.input.empty())
    return failure(ErrorCode::kInvalidArgument, fmt::format("sensor {}: input is empty, expected the file or folder to replay", sensor.name));
  const auto options = common_options(sensor, sensor.replay);
  if (!options) return tl::unexpected(options.error());
  if (sensor.input.ends_with(".mcap")) {
    auto recording = open_mcap(sensor.input, *options);
    if (!recording) return tl::unexpected(recording.error());
    return std::unique_ptr<FrameSource>(std::move(*recording));
  }
  auto source = open_replay(sensor.input, *options);
  if (!source) return tl::unexpected(source.error());
  return std::unique_ptr<FrameSource>(std::move(*source));
}

Result<std::unique_ptr<FrameSource>> make_synthetic(const SensorConfig& sensor) {
  SyntheticOptions options = sensor.synthetic;
  options.sensor = sensor.name;
  return std::unique_ptr<FrameSource>(std::make_unique<SyntheticSource>(options));
}

#ifdef GFP_HAS_FREENECT
Result<std::unique_ptr<FrameSource>> make_freenect(const SensorConfig& sensor) {
  auto options = common_options(sensor, sensor.freenect);
  if (!options) return tl::unexpected(options.error());
  options->folder = sensor.input;
  return make_freenect_source(std::move(*options));
}
#endif

#ifdef GFP_HAS_OPENNI2
Result<std::unique_ptr<FrameSource>> make_openni2(const SensorConfig& sensor) {
  auto options = common_options(sensor, sensor.openni2);
  if (!options) return tl::unexpected(options.error());
  options->uri = sensor.input;
  return make_openni2_source(std::move(*options));
}
#endif

#ifdef GFP_HAS_BUMBLEBEE
Result<std::unique_ptr<FrameSource>> make_bumblebee(const SensorConfig& sensor) {
  if (sensor.calibration.empty())
    return failure(ErrorCode::kInvalidArgument, fmt::format("sensor {}: calibration is empty, expected a stereo calibration (`gfp calibrate` makes one)", sensor.name));
  const auto calibration = config::load_stereo_calibration(sensor.calibration);
  if (!calibration) return tl::unexpected(calibration.error());
  auto rectifier = StereoRectifier::make(*calibration);
  if (!rectifier) return tl::unexpected(rectifier.error());
  BumblebeeOptions options = sensor.bumblebee;
  options.sensor = sensor.name;
  options.device = sensor.input;
  return make_bumblebee_source(std::move(options), stereo_to_frame(std::move(*rectifier), sensor.stereo, calibration->T_world_sensor));
}
#endif

Result<std::unique_ptr<FrameSource>> make_driver(const SensorConfig& sensor) {
  if (sensor.driver == "replay") return make_replay(sensor);
  if (sensor.driver == "synthetic") return make_synthetic(sensor);
#ifdef GFP_HAS_FREENECT
  if (sensor.driver == "freenect") return make_freenect(sensor);
#endif
#ifdef GFP_HAS_BUMBLEBEE
  if (sensor.driver == "bumblebee") return make_bumblebee(sensor);
#endif
#ifdef GFP_HAS_OPENNI2
  if (sensor.driver == "openni2") return make_openni2(sensor);
#endif
  return failure(ErrorCode::kUnsupported, fmt::format("sensor {}: driver = {}, which this build has not", sensor.name, sensor.driver));
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_source(const SensorConfig& sensor) {
  auto source = make_driver(sensor);
  if (!source) return source;
  if (sensor.isolation == "process") return make_isolated_source(sensor, (*source)->info());
  return with_failure(std::move(*source), sensor.failure);
}

}  // namespace gfp
