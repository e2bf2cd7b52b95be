#include "gfp/memory/scene_memory.hpp"

#include <algorithm>

namespace gfp {

const SensorTrack* Track::seen_by(const std::string& sensor) const {
  const auto found = std::find_if(sensors.begin(), sensors.end(), [&](const SensorTrack& seen) { return seen.sensor == sensor; });
  return found != sensors.end() ? &*found : nullptr;
}

const Track* SceneMemory::track(std::uint64_t id) const {
  const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const Track& track) { return track.id == id; });
  return found != tracks.end() ? &*found : nullptr;
}

const SensorMemory& SceneMemory::of(const std::string& sensor) const {
  static const SensorMemory kNothing;
  const auto found = sensors.find(sensor);
  return found != sensors.end() ? found->second : kNothing;
}

}  // namespace gfp
