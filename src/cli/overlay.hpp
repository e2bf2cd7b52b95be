#pragma once

#include <string>

#include "gfp/core/image.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/grasp/grasp.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// Draws a frame and all that was made of it, so that a person sees at once whether it is right:
/// left, the image (colour, else shaded depth) with the segments' outlines, the fitted meshes (hatched where inferred), the
/// support's outline and the grasps (the best one bold); right, the same from a virtual camera turned by 60 degrees about the
/// table's up, over the measured points, so that the hidden side is seen; below, a line an object and the rejected segments.
///
/// `memory` is the one after the frame: it knows the segments' pixels. About 2300 x 1100 pixels whatever the frame's size.
Image<Rgb8> draw_overlay(const Frame& frame, const Scene& scene, const SceneMemory& memory, const Gripper& gripper, const std::string& title);

/// Class and its probability, as in `mug 0.93`.
std::string class_label(const SceneObject& object);

}  // namespace gfp
