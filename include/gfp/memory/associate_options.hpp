#pragma once

namespace gfp {

/// How objects are cut out, known again and found unchanged.
struct AssociateOptions {
  int min_margin_px = 12;          ///< A view shows at least this much around its object...
  double margin = 0.25;            ///< ... and this share of the longer side of its bounding box.
  double max_step_m = 0.10;        ///< An object moves no farther from one frame to the next; more while it is out of sight.
  double min_affinity = 0.2;       ///< Of a segment and a track, to be one object: IoU of pixels (0..1) + nearness (0..1).
  int max_missed_frames = 90;      ///< An object that is out of sight longer gets a new id when it comes back.
  double unchanged_iou = 0.80;     ///< Least overlap of two masks of an object that did not move.
  double unchanged_shift_px = 0.5; ///< Most that the mask's centre may move.
  double unchanged_sigmas = 0.5;   ///< Most that the mean depth may move, in standard deviations of one reading.
  int field_views = 2;             ///< Views of an object from elsewhere that its fit looks at as well; 0: only the frame's own.
  double field_angle_deg = 15;     ///< Directions to the object that are nearer to each other show the same.
  int look_again_every = 30;       ///< Frames that show the same as the last one looked at are not looked at, except one in so many; 1: every frame is.
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
  field("field_views", o.field_views, 0, 6);
  field("field_angle_deg", o.field_angle_deg, 1.0, 90.0);
  field("look_again_every", o.look_again_every, 1, 100'000);
}

}  // namespace gfp
