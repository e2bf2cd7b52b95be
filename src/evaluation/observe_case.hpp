#pragma once

#include <optional>

#include "gfp/evaluation/cases.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/pipeline/pipeline_options.hpp"

namespace gfp {

/// What the pipeline's front end makes of a case.
struct CaseObservation {
  std::optional<ObjectView> view;              ///< Empty where no segment covers the object.
  double segment_iou = 0;
  std::vector<Eigen::Vector3d> points_camera;  ///< The object's true readings.
};

/// Cloud, segmentation (with the true mask as the user's where `mask_from_truth`), normals, and the view of the segment that
/// overlaps the object best; what the other standpoints show of it becomes its field.
CaseObservation observe_case(const EvaluationCase& shown, const PipelineOptions& options, bool mask_from_truth);

}  // namespace gfp
