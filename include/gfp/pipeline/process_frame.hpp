#pragma once

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/cloud/estimate_normals.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/grasp/plan_grasps.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/segmentation/segment_cloud.hpp"
#include "gfp/selection/select_models.hpp"

namespace gfp {

/// Every stage's options: the configuration's `pipeline` section.
struct PipelineOptions {
  std::string profile = "robust";
  std::string method = "gfp_robust";
  DepthToCloudOptions cloud;
  EstimateNormalsOptions normals;
  SegmentationOptions segmentation;
  RecognitionOptions recognition;
  RegistrationOptions registration;
  ModellingOptions modelling;
  SelectionOptions selection;
  Gripper gripper;
  PlanGraspsOptions grasp;
};

/// A frame's result and what the next frame needs of it.
struct PipelineResult {
  Scene scene;
  SceneMemory memory;
};

/// The whole pipeline, capture to Scene: pure; the same inputs give the same bytes at any thread count. Parallel over objects
/// in the calling oneTBB arena. A bad segment costs that segment (Scene::rejected), never the frame.
PipelineResult process_frame(const Frame& frame, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options = {});

}  // namespace gfp
