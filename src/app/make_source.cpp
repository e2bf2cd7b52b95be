#include "app/make_source.hpp"

#include <fmt/format.h>

#include "config/camera_file.hpp"
#ifdef GFP_HAS_FREENECT
#include "freenect/freenect_source.hpp"
#endif
#include "replay/replay_source.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

Result<std::unique_ptr<FrameSource>> make_replay(const SensorConfig& sensor) {
  if (sensor.input.empty())
    return failure(ErrorCode::kInvalidArgument, fmt::format("sensor {}: input is empty, expected the file or folder to replay", sensor.name));
  ReplayOptions options = sensor.replay;
  options.sensor = sensor.name;
  if (!sensor.camera.empty()) {
    auto camera = config::load_camera(sensor.camera);
    if (!camera) return tl::unexpected(camera.error());
    options.camera = std::move(*camera);
  }
  auto source = open_replay(sensor.input, options);
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
  FreenectOptions options = sensor.freenect;
  options.sensor = sensor.name;
  options.folder = sensor.input;
  if (!sensor.camera.empty()) {
    auto camera = config::load_camera(sensor.camera);
    if (!camera) return tl::unexpected(camera.error());
    options.camera = std::move(*camera);
  }
  return make_freenect_source(std::move(options));
}
#endif

}  // namespace

Result<std::unique_ptr<FrameSource>> make_source(const SensorConfig& sensor) {
  if (sensor.driver == "replay") return make_replay(sensor);
  if (sensor.driver == "synthetic") return make_synthetic(sensor);
#ifdef GFP_HAS_FREENECT
  if (sensor.driver == "freenect") return make_freenect(sensor);
#endif
  return failure(ErrorCode::kUnsupported, fmt::format("sensor {}: driver = {}, which this build has not", sensor.name, sensor.driver));
}

}  // namespace gfp
