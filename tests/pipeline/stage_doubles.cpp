#include "pipeline/stage_doubles.hpp"

#include <algorithm>
#include <limits>

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/cloud/estimate_normals.hpp"
#include "gfp/grasp/plan_grasps.hpp"
#include "gfp/modelling/fit_simple_primitive.hpp"
#include "gfp/modelling/fit_superquadric.hpp"
#include "gfp/modelling/follow_model.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/follow_shape.hpp"
#include "gfp/registration/register_paper.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "gfp/registration/retrieve_instance.hpp"
#include "gfp/segmentation/segment_cloud.hpp"
#include "gfp/selection/select_models.hpp"
#include "support/box_model.hpp"

namespace gfp {
namespace test {

void StageScript::reset() {
  cost_of_class.clear();
  for (auto* count : {&recognised, &registered, &contoured, &followed, &superquadrics, &planned}) *count = 0;
}

StageScript& script() {
  static StageScript instance;
  return instance;
}

PrimitiveLibrary library_of(const std::vector<std::string>& class_names) {
  std::vector<PrimitivePtr> primitives;
  for (const std::string& name : class_names) {
    auto primitive = std::make_shared<Primitive>();
    primitive->name = primitive->class_name = name;
    primitives.push_back(primitive);
  }
  return PrimitiveLibrary(primitives);
}

Frame block_frame(const std::vector<Block>& blocks, std::uint64_t sequence) {
  Frame frame;
  frame.sensor = "blocks";
  frame.sequence = sequence;
  frame.camera = default_kinect_camera(160, 120);
  frame.depth.pixels = Image<std::uint16_t>(160, 120, kPlaneMm);
  for (const Block& block : blocks)
    for (int v = block.rect.v0; v < block.rect.v1; ++v)
      for (int u = block.rect.u0; u < block.rect.u1; ++u) frame.depth.pixels.at(u, v) = static_cast<std::uint16_t>(1000 * block.depth_m + 0.5);
  return frame;
}

namespace {

double cost_of(const std::string& class_name) {
  const auto found = script().cost_of_class.find(class_name);
  return found == script().cost_of_class.end() ? 1.0 : found->second;
}

/// Blocks by their depth, nearest first.
std::vector<Block> blocks_in(const OrganizedCloud& cloud) {
  std::map<int, PixelRect> boxes;
  for (int v = 0; v < cloud.height; ++v) {
    for (int u = 0; u < cloud.width; ++u) {
      const int mm = static_cast<int>(1000 * cloud.z[static_cast<std::size_t>(v * cloud.width + u)] + 0.5F);
      if (mm == kPlaneMm) continue;
      PixelRect& box = boxes.try_emplace(mm, PixelRect{u, v, u + 1, v + 1}).first->second;
      box = {std::min(box.u0, u), std::min(box.v0, v), std::max(box.u1, u + 1), std::max(box.v1, v + 1)};
    }
  }
  std::vector<Block> blocks;
  for (const auto& [mm, box] : boxes) blocks.push_back({box, 1e-3 * mm});
  return blocks;
}

}  // namespace
}  // namespace test

PrimitiveLibrary::PrimitiveLibrary(std::vector<PrimitivePtr> primitives) : primitives_(std::move(primitives)) {}
PrimitivePtr PrimitiveLibrary::find(std::string_view class_name) const {
  for (const PrimitivePtr& primitive : primitives_)
    if (primitive->class_name == class_name) return primitive;
  return nullptr;
}

OrganizedCloud depth_to_cloud(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions&) {
  OrganizedCloud cloud{camera.width, camera.height, {}, {}, {}, camera};
  for (auto* plane : {&cloud.x, &cloud.y, &cloud.z}) plane->resize(depth.pixels.pixels.size());
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) test::set_point(cloud, u, v, depth.scale_m * depth.pixels.at(u, v));
  return cloud;
}

NormalMap estimate_normals(const OrganizedCloud& cloud, const EstimateNormalsOptions&, const std::vector<PixelRect>&) {
  return {cloud.width, cloud.height, std::vector<float>(cloud.size(), 0), std::vector<float>(cloud.size(), 0), std::vector<float>(cloud.size(), -1)};
}

Segments segment_cloud(const OrganizedCloud& cloud, const SegmentationOptions&, const std::optional<Eigen::Vector3d>&, const SupportPlane*,
                       const Image<std::uint8_t>&) {
  return test::block_scene(test::blocks_in(cloud), 0, cloud.width, cloud.height).segments;
}

std::vector<Hypothesis> recognise(const ObjectView&, const PrimitiveLibrary& library, const RecognitionOptions&) {
  ++test::script().recognised;
  std::vector<Hypothesis> hypotheses;
  for (const PrimitivePtr& primitive : library.all()) hypotheses.push_back({primitive, -1.0, {0}});
  return hypotheses;
}

std::vector<Placement> register_hypotheses(const ObjectView&, std::span<const Hypothesis> hypotheses, const RegistrationOptions&) {
  std::vector<Placement> placements;
  for (const Hypothesis& hypothesis : hypotheses) {
    ++test::script().registered;
    Placement placement;
    placement.primitive = hypothesis.primitive;
    placement.hypothesis = static_cast<int>(placements.size());
    placement.cost = test::cost_of(hypothesis.primitive->class_name);
    placements.push_back(placement);
  }
  std::sort(placements.begin(), placements.end(), [](const Placement& a, const Placement& b) { return a.cost < b.cost; });
  return placements;
}

FittedModel model_contour(const ObjectView& view, const Placement& placement, const ModellingOptions&) {
  ++test::script().contoured;
  FittedModel model = test::box_model("gfp_robust", placement.primitive->class_name, {0.1, 0.1, 0.1}, placement.cost);
  model.primitive = placement.primitive;
  model.T_camera_object.translation() = view.camera.ray(view.tile.u0, view.tile.v0);
  return model;
}

FollowedPose follow_shape(const ObjectView& view, const std::vector<Eigen::Vector3d>&, const std::shared_ptr<const Topology>&, const Transform&,
                          const RegistrationOptions&) {
  FollowedPose pose;
  pose.T_camera_object.translation() = view.camera.ray(view.tile.u0, view.tile.v0);
  return pose;
}

FittedModel follow_model(const ObjectView&, const FittedModel& before, const FollowedPose& pose) {
  ++test::script().followed;
  FittedModel model = before;
  model.T_camera_object = pose.T_camera_object;
  model.evidence.cost = test::cost_of(model.class_name);
  return model;
}

Placement register_paper(const ObjectView& view, const Hypothesis& hypothesis, const PaperRegistrationOptions&) {
  return register_hypotheses(view, {&hypothesis, 1}, {}).front();
}

FittedModel model_contour_paper(const ObjectView& view, const Placement& placement, const PaperContourOptions&, ContourDirections, ContourTrace*) {
  FittedModel model = model_contour(view, placement);
  model.method = "gfp_paper";
  return model;
}

FittedModel model_placed(const ObjectView& view, const Placement& placement, const std::string& method) {
  FittedModel model = model_contour(view, placement);
  model.method = method;
  return model;
}

Placement retrieve_instance(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, const RetrieveInstanceOptions&) {
  return hypotheses.empty() ? Placement{} : register_hypotheses(view, hypotheses, {}).front();
}

FittedModel fit_simple_primitive(const ObjectView&) { return test::box_model("simple_primitive", "unknown", {0.1, 0.1, 0.1}, 2.0); }

FittedModel fit_sphere_snake(const ObjectView&, const PaperContourOptions&, ContourDirections, ContourTrace*) { return test::box_model("sphere_snake", "unknown", {0.1, 0.1, 0.1}, 2.0); }

FittedModel fit_superquadric(const ObjectView&, const FitSuperquadricOptions&) {
  ++test::script().superquadrics;
  return test::box_model("superquadric", "unknown", {0.1, 0.1, 0.1}, test::cost_of("unknown"));
}

bool unknown_may_win(const std::vector<Candidate>& candidates, const SelectionOptions&) {
  return std::none_of(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.model.evidence.cost < test::cost_of("unknown") - 3; });
}

std::vector<ObjectEstimate> select_models(const std::vector<ObjectView>& views, std::vector<std::vector<Candidate>> candidates, const SelectionOptions&) {
  std::vector<ObjectEstimate> estimates;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto best = std::min_element(candidates[i].begin(), candidates[i].end(),
                                       [](const Candidate& a, const Candidate& b) { return a.model.evidence.cost < b.model.evidence.cost; });
    ObjectEstimate estimate{views[i].id, views[i].segment, best->model, {}};
    for (const Candidate& candidate : candidates[i]) estimate.class_probabilities[candidate.model.class_name] = 1.0 / static_cast<double>(candidates[i].size());
    estimates.push_back(estimate);
  }
  return estimates;
}

GraspPlan plan_grasps(const FittedModel&, const GraspScene& scene, const Gripper&, const PlanGraspsOptions&) {
  ++test::script().planned;
  return {{}, std::to_string(scene.neighbours.size()) + " neighbours"};
}

}  // namespace gfp
