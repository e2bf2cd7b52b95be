#pragma once

#include <string>
#include <vector>

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/cloud/estimate_normals.hpp"
#include "gfp/core/error.hpp"
#include "gfp/grasp/plan_grasps.hpp"
#include "gfp/memory/associate.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/register_paper.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "gfp/segmentation/segment_cloud.hpp"
#include "gfp/selection/select_models.hpp"

namespace gfp {

/// How much work one object's fit may be.
struct FitBudgetOptions {
  int max_contours = 2;           ///< Placements, over all hypotheses, that get a contour: those of least cost.
  int search_every = 30;          ///< Every so many fits of a tracked object all classes are searched again; 1: always.
  int reshape_every = 6;          ///< Every so many fits its shape is fitted again; between them only its pose is; 1: always.
  double warm_cost_slack = 0.25;  ///< A tracked fit whose cost grew by more than this is searched again at once.
  double shape_cost_slack = 0.1;  ///< A shape that, at its new pose, costs this much more than when it was fitted is fitted again at once.
};

template <class Visitor>
void visit_fields(FitBudgetOptions& o, Visitor&& field) {
  field("max_contours", o.max_contours, 1, 64);
  field("search_every", o.search_every, 1, 100'000);
  field("reshape_every", o.reshape_every, 1, 100'000);
  field("warm_cost_slack", o.warm_cost_slack, 0.0, 100.0);
  field("shape_cost_slack", o.shape_cost_slack, 0.0, 100.0);
}

/// Of the methods that the paper is or compares itself with: gfp_paper, gfp_grid26, sphere_snake.
struct PaperOptions {
  PaperRegistrationOptions registration;
  PaperContourOptions contour;
};

template <class Visitor>
void visit_fields(PaperOptions& o, Visitor&& field) {
  field.section("registration", o.registration);
  field.section("contour", o.contour);
}

/// Every stage's options: the configuration's `pipeline` section.
struct PipelineOptions {
  std::string profile = "robust";
  std::string method = "gfp_robust";
  std::string shadow;  ///< A method that gfpd runs beside it, at low priority, and publishes under /gfp/shadow/; empty: none.
  DepthToCloudOptions cloud;
  EstimateNormalsOptions normals;
  SegmentationOptions segmentation;
  AssociateOptions memory;
  RecognitionOptions recognition;
  RegistrationOptions registration;
  ModellingOptions modelling;
  PaperOptions paper;
  FitBudgetOptions budget;
  SelectionOptions selection;
  Gripper gripper;
  PlanGraspsOptions grasp;
};

template <class Visitor>
void visit_fields(PipelineOptions& o, Visitor&& field) {
  field("profile", o.profile);
  field("method", o.method);
  field("shadow", o.shadow);
  field.section("cloud", o.cloud);
  field.section("normals", o.normals);
  field.section("segmentation", o.segmentation);
  field.section("memory", o.memory);
  field.section("recognition", o.recognition);
  field.section("registration", o.registration);
  field.section("modelling", o.modelling);
  field.section("paper", o.paper);
  field.section("budget", o.budget);
  field.section("selection", o.selection);
  field.section("gripper", o.gripper);
  field.section("grasp", o.grasp);
}

/// Names that PipelineOptions::profile and ::method may have, in the order in which they are listed to people.
std::vector<std::string> profile_names();
std::vector<std::string> method_names();

/// Errors: kNotFound, naming an unknown profile, method or shadow and the known ones.
Result<void> validate(const PipelineOptions& options);

}  // namespace gfp
