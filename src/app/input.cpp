#include "app/input.hpp"

#include <utility>

namespace gfp {
namespace {

/// The last name of the path without its extension, also for `folder/`.
std::string stem_of(const std::filesystem::path& path) {
  const std::filesystem::path last = path.has_filename() ? path : path.parent_path();
  const std::string stem = last.stem().string();
  return stem.empty() || stem == "." || stem == ".." ? "input" : stem;
}

}  // namespace

Result<Input> open_input(const std::string& name, const InputOptions& options) {
  ReplayOptions replay;
  replay.rate_hz = 0;
  replay.frame_time = true;
  replay.camera = options.camera;
  replay.depth_scale_m = options.depth_scale_m;
  replay.axes = options.axes;
  auto source = open_replay(name, replay);
  if (!source) return tl::unexpected(source.error());
  if (auto opened = (*source)->open(); !opened) return tl::unexpected(opened.error());
  return Input{name, stem_of(name), std::move(*source)};
}

}  // namespace gfp
