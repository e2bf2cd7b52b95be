#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/frame/frame.hpp"
#include "gfp/memory/object_field.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

struct SceneObject;  // of the step `scene`: carried to the next frame, never looked into by `memory`

/// What one sensor saw of an object last.
struct SensorTrack {
  std::string sensor;
  Transform T_world_sensor = Transform::Identity();         ///< Where it was then.
  PixelRect bbox;
  std::vector<std::int32_t> pixels;                         ///< Of the segment, ascending.
  int missed_frames = 0;                                    ///< Of this sensor, since then.
  /// Shared since both are large, never change and are handed from frame to frame: the view that `object` was fitted to
  /// (not the last one seen, so that a slow drift adds up and is noticed), and what was published of it.
  std::shared_ptr<const ObjectView> fitted_view;
  std::shared_ptr<const SceneObject> object;
};

/// What one frame leaves to the next about one object.
struct Track {
  std::uint64_t id = 0;
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();   ///< Of the object's seen points.
  double height_m = 0;                                      ///< As in its last view.
  WarmStart fit;                                            ///< The last one, of whichever sensor...
  Transform T_world_fit = Transform::Identity();            ///< ... whose camera frame it is in.
  std::vector<SensorTrack> sensors;                         ///< Never empty; who saw it last comes first.
  ObjectField field;

  const SensorTrack& last() const { return sensors.front(); }
  const SensorTrack* seen_by(const std::string& sensor) const;
};

/// The last frame of a sensor that went through every stage, as far as the next one is compared with it.
struct Look {
  Frame frame;                                              ///< Without colour.
  std::optional<SupportPlane> support;
  std::vector<RejectedSegment> rejected;
  std::uint64_t field_changes = 0;                          ///< SceneMemory's, after that frame.
};

/// What one frame leaves to the next one of the same sensor.
struct SensorMemory {
  std::optional<SupportPlane> last_support;                 ///< In its camera frame.
  std::shared_ptr<const Look> look;
  int frames_since_look = 0;                                ///< That showed the same as `look`.
};

/// All the state of the pipeline; a value. Frame N's memory and frame N + 1 give frame N + 1's memory.
struct SceneMemory {
  std::uint64_t next_id = 1;
  std::uint64_t frames = 0;
  std::uint64_t field_changes = 0;                          ///< How often any object's field changed so far.
  std::vector<Track> tracks;                                ///< By id, ascending.
  std::map<std::string, SensorMemory> sensors;              ///< By name.

  /// By id; nullptr where there is none.
  const Track* track(std::uint64_t id) const;
  /// What is remembered of a sensor; nothing yet where it is new.
  const SensorMemory& of(const std::string& sensor) const;
};

}  // namespace gfp
