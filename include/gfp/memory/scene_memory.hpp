#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// What one frame leaves to the next about one object.
struct Track {
  std::uint64_t id = 0;
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();   ///< Of the object's seen points.
  PixelRect bbox;
  std::vector<std::int32_t> pixels;                         ///< Of its last segment, ascending.
  WarmStart fit;
  int missed_frames = 0;
};

/// All the state of the pipeline; a value. Frame N's memory and frame N + 1 give frame N + 1's memory.
struct SceneMemory {
  std::uint64_t next_id = 1;
  std::uint64_t frames = 0;
  std::vector<Track> tracks;
  std::optional<SupportPlane> last_support;
};

}  // namespace gfp
