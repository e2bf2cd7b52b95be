#pragma once

#include "gfp/core/camera_model.hpp"
#include "gfp/simulation/virtual_scene.hpp"

namespace gfp {

/// A box that hides part of an object from a camera.
struct Occluder {
  PlacedMesh box;
  double hidden_share = 0;  ///< Share of the object's pixels that it hides.
};

/// A box that stands on the table between the camera (at -y, looking towards +y) and the object, pushed in from one side
/// until it hides `share` of the object's pixels; less where even the whole box hides less. It touches nothing.
Occluder place_occluder(const PlacedMesh& object, const CameraModel& camera, const Transform& T_world_camera, double share, bool from_left);

}  // namespace gfp
