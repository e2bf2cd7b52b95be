#pragma once

namespace gfp {

/// What of a daemon's work goes into a recording.
struct RecordContent {
  bool depth = true;       ///< Losslessly; with the camera and all else that a replay needs.
  bool color = false;      ///< Losslessly: more than doubles the size.
  bool objects = true;     ///< Scenes with objects, meshes and grasps, as they are published.
  double view_hz = 2;      ///< How often the objects are added in a form that Foxglove shows; 0: never.
};

template <class Visitor>
void visit_fields(RecordContent& o, Visitor&& field) {
  field("depth", o.depth);
  field("color", o.color);
  field("objects", o.objects);
  field("view_hz", o.view_hz, 0.0, 30.0);
}

}  // namespace gfp
