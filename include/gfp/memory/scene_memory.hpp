#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/frame/frame.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

struct SceneObject;  // of the step `scene`: carried to the next frame, never looked into by `memory`

/// What one frame leaves to the next about one object.
struct Track {
  std::uint64_t id = 0;
  std::string sensor;                                       ///< Who saw it last.
  Transform T_world_sensor = Transform::Identity();         ///< Where that sensor was; `fit` is in its camera frame.
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();   ///< Of the object's seen points.
  double height_m = 0;                                      ///< As in its last view.
  PixelRect bbox;
  std::vector<std::int32_t> pixels;                         ///< Of its last segment, ascending.
  WarmStart fit;
  int missed_frames = 0;
  /// Shared since both are large, never change and are handed from frame to frame: the view that `object` was fitted to
  /// (not the last one seen, so that a slow drift adds up and is noticed), and what was published of it.
  std::shared_ptr<const ObjectView> fitted_view;
  std::shared_ptr<const SceneObject> object;
};

/// The last frame that went through every stage, as far as the next one is compared with it.
struct Look {
  Frame frame;                                              ///< Without colour.
  std::optional<SupportPlane> support;
  std::vector<RejectedSegment> rejected;
};

/// All the state of the pipeline; a value. Frame N's memory and frame N + 1 give frame N + 1's memory.
struct SceneMemory {
  std::uint64_t next_id = 1;
  std::uint64_t frames = 0;
  std::vector<Track> tracks;                                ///< By id, ascending.
  std::optional<SupportPlane> last_support;
  std::shared_ptr<const Look> look;
  int frames_since_look = 0;                                ///< That showed the same as `look`.
};

}  // namespace gfp
