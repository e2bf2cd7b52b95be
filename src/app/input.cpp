#include "app/input.hpp"

#include <utility>

#ifdef GFP_HAS_OPENNI2
#include "openni2/openni2_source.hpp"
#endif

namespace gfp {
namespace {

/// The last name of the path without its extension, also for `folder/`.
std::string stem_of(const std::filesystem::path& path) {
  const std::filesystem::path last = path.has_filename() ? path : path.parent_path();
  const std::string stem = last.stem().string();
  return stem.empty() || stem == "." || stem == ".." ? "input" : stem;
}

Result<Input> open_oni(const std::string& name, [[maybe_unused]] const InputOptions& options) {
#ifdef GFP_HAS_OPENNI2
  OpenNi2Options oni;
  oni.uri = name;
  oni.fast = oni.frame_time = true;
  oni.camera = options.camera;
  auto source = make_openni2_source(oni);
  if (auto opened = source->open(); !opened) return tl::unexpected(opened.error());
  return Input{name, stem_of(name), std::move(source)};
#else
  return failure(ErrorCode::kUnsupported, name + ": .oni files need OpenNI2, which this build has not");
#endif
}

Result<Input> open_recording(const std::string& name, ReplayOptions options) {
  options.sensor.clear();  // as it was recorded
  auto source = open_mcap(name, options);
  if (!source) return tl::unexpected(source.error());
  if (auto opened = (*source)->open(); !opened) return tl::unexpected(opened.error());
  const McapSource* const opened_source = source->get();
  return Input{name, stem_of(name), std::move(*source), nullptr, opened_source};
}

}  // namespace

Result<Input> open_input(const std::string& name, const InputOptions& options) {
  if (name.ends_with(".oni")) return open_oni(name, options);
  ReplayOptions replay;
  replay.rate_hz = 0;
  replay.frame_time = true;
  replay.camera = options.camera;
  replay.depth_scale_m = options.depth_scale_m;
  replay.axes = options.axes;
  if (name.ends_with(".mcap")) return open_recording(name, replay);
  auto source = open_replay(name, replay);
  if (!source) return tl::unexpected(source.error());
  if (auto opened = (*source)->open(); !opened) return tl::unexpected(opened.error());
  const ReplaySource* const opened_source = source->get();
  return Input{name, stem_of(name), std::move(*source), opened_source};
}

}  // namespace gfp
