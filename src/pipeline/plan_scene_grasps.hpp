#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// Fills in the grasps of every object that changed, has something within the gripper's reach that changed or left, or an
/// obstacle where a grasp would go now; the others keep those they have. `views[i]` is objects[i]'s; what stands above the
/// plane that the object itself stands on is in its way. `left`: objects as they were last seen that are gone.
/// Parallel over objects; each one's milliseconds go into its ms["grasp"].
void plan_scene_grasps(std::vector<SceneObject>& objects, const std::vector<const ObjectView*>& views, const Segments& segments,
                       const OrganizedCloud& cloud, const std::vector<const SceneObject*>& left, const PipelineOptions& options);

}  // namespace gfp
