#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

struct AssociateOptions {
  int min_margin_px = 12;          ///< A view shows at least this much around its object...
  double margin = 0.25;            ///< ... and this share of the longer side of its bounding box.
  double max_step_m = 0.10;        ///< An object moves no farther from one frame to the next; more while it is out of sight.
  double min_affinity = 0.2;       ///< Of a segment and a track, to be one object: IoU of pixels (0..1) + nearness (0..1).
  int max_missed_frames = 90;      ///< An object that is out of sight longer gets a new id when it comes back.
  double unchanged_iou = 0.80;     ///< Least overlap of two masks of an object that did not move.
  double unchanged_shift_px = 0.5; ///< Most that the mask's centre may move.
  double unchanged_sigmas = 0.5;   ///< Most that the mean depth may move, in standard deviations of one reading.
};

template <class Visitor>
void visit_fields(AssociateOptions& o, Visitor&& field) {
  field("min_margin_px", o.min_margin_px, 0, 500);
  field("margin", o.margin, 0.0, 2.0);
  field("max_step_m", o.max_step_m, 0.0, 2.0);
  field("min_affinity", o.min_affinity, 0.01, 2.0);
  field("max_missed_frames", o.max_missed_frames, 0, 100'000);
  field("unchanged_iou", o.unchanged_iou, 0.0, 1.0);
  field("unchanged_shift_px", o.unchanged_shift_px, 0.0, 100.0);
  field("unchanged_sigmas", o.unchanged_sigmas, 0.0, 100.0);
}

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

}  // namespace gfp
