#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gfp/memory/associate_options.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/selection/object_estimate.hpp"

namespace gfp {

/// What is published of an estimate, apart from its grasps: with volumes (m^3; filled = every cavity closed at its rim),
/// closedness and self-intersections measured on the mesh itself.
SceneObject describe(ObjectEstimate estimate, const ObjectView& view, ObjectStatus status);

/// Ids that `sensor` saw in its last frame and does not see in this one, ascending. An object that comes back is ADDED
/// again, under its old id.
std::vector<std::uint64_t> lost_ids(const SceneMemory& memory, const std::vector<ObjectView>& views, const std::string& sensor);

/// The scene of a frame that shows the same as the sensor's last look (`shows_the_same`), without its stamps: every object that `sensor` saw
/// then, kUnchanged.
Scene standing_scene(const SceneMemory& memory, const std::string& sensor);

/// The memory after such a frame.
SceneMemory remember_standing(SceneMemory memory, const std::string& sensor, const AssociateOptions& options = {});

/// The memory after a frame that was looked at: `memory` with every object of `scene` and every view, whether it was fitted or not.
/// A track out of sight is kept for options.max_missed_frames frames of its sensor.
SceneMemory remember(const Scene& scene, const Frame& frame, const std::vector<ObjectView>& views, const SceneMemory& memory,
                     const AssociateOptions& options = {});

}  // namespace gfp
