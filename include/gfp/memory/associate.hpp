#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/memory/associate_options.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// Cuts every segment out of the frame as an ObjectView and says which known object it is.
///
/// `cloud`, `normals` and `segments` belong to `frame`; `normals` needs values at segment pixels only and may be empty
/// (then the views have none). Identity: the assignment of segments to tracks with the greatest sum of affinities
/// (optimal, not greedy); a track of another sensor, or of this one at another pose, is compared by 3-D distance only.
/// What matches nothing gets a new id from memory.next_id on.
/// Segments without a support plane get a guess of it: z along the accelerometer's up, else the last plane's normal,
/// else the image's up; origin below the object's centre at its lowest point.
/// @return views[i] of segments.segments[i]. No segment, no view. Cost: O(image tiles + tracks^3 of a few hundred).
std::vector<ObjectView> associate(const Segments& segments, const OrganizedCloud& cloud, const NormalMap& normals,
                                  const Frame& frame, const SceneMemory& memory, const AssociateOptions& options = {});

/// Whether two views of one object show the same surface in the same place, to within the sensor's noise.
bool same_within_noise(const ObjectView& now, const ObjectView& before, const AssociateOptions& options = {});

/// Whether two frames show one scene from one standpoint with nothing moved, to within the sensor's noise: in patches of 32 x 32
/// pixels the mean depth stayed within a standard deviation of one reading, and in blocks of 16 x 16 no edge moved by two pixels and
/// less than half of the readings came or went. What moves by less adds up until it is seen. Cost: 0.2 ms at 640 x 480.
bool shows_the_same(const Frame& now, const Frame& before);

}  // namespace gfp
