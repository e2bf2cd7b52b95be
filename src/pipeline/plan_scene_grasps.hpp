#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// Fills in the grasps of every object that changed or has something that changed within the gripper's reach; the others
/// keep those they have. `views[i]` is objects[i]'s. `someone_left`: an object is gone, so all are planned anew.
/// Parallel over objects; each one's milliseconds go into its ms["grasp"].
void plan_scene_grasps(std::vector<SceneObject>& objects, const std::vector<const ObjectView*>& views, const Segments& segments,
                       const OrganizedCloud& cloud, bool someone_left, const PipelineOptions& options);

}  // namespace gfp
