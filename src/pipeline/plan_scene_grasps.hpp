#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// An object on its way to its grasps, with what it was in the frame before (null where it was not there).
struct GraspSubject {
  SceneObject* object = nullptr;
  const ObjectView* view = nullptr;
  const SceneObject* before = nullptr;
  const ObjectView* view_before = nullptr;
};

/// Fills in the grasps of every object that has a new shape, stands otherwise, has something within the gripper's reach that came, left
/// or moved relative to it, or an obstacle where a grasp would go now; the others keep those they have, moved along with them. What
/// stands above the plane that the object itself stands on is in its way. `left`: objects as they were last seen that are gone.
/// Parallel over objects; each one's milliseconds go into its ms["grasp"].
void plan_scene_grasps(const std::vector<GraspSubject>& subjects, const Segments& segments, const OrganizedCloud& cloud,
                       const std::vector<const SceneObject*>& left, const PipelineOptions& options);

}  // namespace gfp
