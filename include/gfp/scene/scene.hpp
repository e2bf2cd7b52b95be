#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/image.hpp"
#include "gfp/core/time.hpp"
#include "gfp/grasp/grasp.hpp"
#include "gfp/segmentation/segments.hpp"
#include "gfp/selection/object_estimate.hpp"

namespace gfp {

enum class ObjectStatus : std::uint8_t { kAdded, kUpdated, kUnchanged, kLost };

/// One object as published.
struct SceneObject {
  std::uint64_t id = 0;
  ObjectStatus status = ObjectStatus::kAdded;
  std::map<std::string, double> class_probabilities;
  FittedModel model;
  GraspPlan grasps;
  int pixels = 0;
  PixelRect bbox;
  bool touches_border = false, occluded = false;
  double volume_material_m3 = 0, volume_filled_m3 = 0;
  bool closed = false;
  int self_intersections = 0;
  bool fresh = true;                       ///< False: the fit is an earlier frame's (work was shed).
  std::map<std::string, double> ms;        ///< Per stage, not part of any hash.
};

/// All that one frame told.
struct Scene {
  std::string sensor;
  std::uint64_t sequence = 0;
  Stamps stamps;
  CameraModel camera;
  Transform T_world_sensor = Transform::Identity();
  std::optional<SupportPlane> support;     ///< The largest plane.
  std::vector<SceneObject> objects;        ///< By id, ascending.
  std::vector<std::uint64_t> lost;         ///< Ids that were there before and are gone.
  std::vector<RejectedSegment> rejected;
  std::string profile;                     ///< robust or paper.
  std::map<std::string, double> ms;        ///< Per stage, not part of any hash.
};

}  // namespace gfp
