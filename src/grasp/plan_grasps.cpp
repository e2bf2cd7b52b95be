#include "gfp/grasp/plan_grasps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "gfp/core/spread_directions.hpp"
#include "gfp/grasp/wrench_space.hpp"
#include "grasp/close_jaw.hpp"
#include "grasp/contact_candidates.hpp"
#include "grasp/jaw_poses.hpp"
#include "grasp/shape_uncertainty.hpp"
#include "grasp/surroundings.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kTightClearance = 0.4;    // share of the opening clearance where space is tight
constexpr double kShallowDepth = 0.35;     // share of the pad depth where a finger would meet the table or the palm the object
constexpr double kMarginLimit = 0.2;       // metres: collision_margin_m looks no farther
constexpr int kBodyEffort = 3000, kEdgeEffort = 3000, kWiderEffort = 2000;  // in looks at the palm alone: the bulk of the time
constexpr int kSceneCheck = 8, kWholeCheck = 48;  // what a look at the surroundings and closing the jaw in all depths cost, likewise
constexpr double kBesideTheBody = 0.6;     // what a grip is worth that has the centre of mass beside its pads, not between them
constexpr double kWidestStroke = 0.5;      // metres: a jaw for the question whether the stroke alone is too small

/// One pose that was closed on the fitted mesh.
struct ClosedGrasp {
  JawPose pose;  // centred on the touches
  Transform T_camera_tcp;
  double opening_m = 0;
  std::array<PadTouch, 2> touches;  // tcp frame
  GraspQuality quality;
  ClosureStatistics closure;
  double margin_m = 0, score = 0;
};

/// The farthest points in directions spread over the sphere, each once.
std::vector<Vector3d> extreme_points(const std::vector<Vector3d>& points) {
  constexpr int kDirections = 48;
  std::vector<Vector3d> extremes;
  for (const Vector3d& direction : spread_directions(kDirections)) {
    const auto farthest = std::max_element(points.begin(), points.end(), [&](const Vector3d& a, const Vector3d& b) { return direction.dot(a) < direction.dot(b); });
    if (std::find(extremes.begin(), extremes.end(), *farthest) == extremes.end()) extremes.push_back(*farthest);
  }
  return extremes;
}

/// What keeps a jaw from holding the object.
enum class Obstruction {
  kNone,
  kDepth,    ///< The palm meets the object or the tips the table: a shallower grip may help.
  kFingers,  ///< The fingers meet the object, or the gripper something of the scene: a smaller opening may help.
  kSlips,    ///< The closed pads do not hold.
};

class Planner {
 public:
  Planner(const FittedModel& model, const GraspScene& scene, const Gripper& gripper, const PlanGraspsOptions& options)
      : model_(model), gripper_(gripper), options_(options), mesh_(model.mesh_camera()), normals_(triangle_normals(mesh_)),
        bvh_(mesh_.vertices, mesh_.triangles), scale_(wrench_scale(mesh_)),
        up_(scene.has_support ? Vector3d(scene.T_camera_support.linear().col(2)) : Vector3d(-scale_.centre.normalized())),
        surroundings_(scene, scale_.centre, scale_.radius_m + reach()), stroke_m_(gripper.stroke_m) {
    for (const Triangle& triangle : mesh_.triangles) sigma_.push_back(sigma(triangle));
    extremes_ = extreme_points(mesh_.vertices);
  }

  GraspPlan plan();

 private:
  double reach() const {
    return gripper_.finger_length_m + gripper_.palm_depth_m + gripper_.palm_width_m + options_.pregrasp_offset_m + kMarginLimit;
  }
  float sigma(const Triangle& triangle) const;
  bool observed(std::int32_t triangle) const;
  void close_poses(const std::vector<AntipodalPair>& pairs, int effort, std::size_t enough, std::vector<ClosedGrasp>& closed, int& examined);
  std::string why_none(const PairSearch& search);
  std::optional<ClosedGrasp> try_pose(const JawPose& pose);
  Obstruction close(ClosedGrasp& grasp, double depth_m, bool may_align = true);
  bool align(ClosedGrasp& grasp, double depth_m);
  Obstruction obstruction(const ClosedGrasp& grasp, double sweep_m);
  bool hopeless(const JawPose& pose) const;
  bool palm_meets(const JawPose& pose) const;
  bool blocked(const JawPose& pose);
  double least_depth(const JawPose& pose) const;
  void value(ClosedGrasp& grasp, const std::vector<ShapeDraw>& draws);
  Grasp published(const ClosedGrasp& grasp) const;

  const FittedModel& model_;
  const Gripper& gripper_;
  const PlanGraspsOptions& options_;
  TriangleMesh mesh_;  // camera frame
  std::vector<Vector3d> normals_;
  TriangleBvh bvh_;
  WrenchScale scale_;
  Vector3d up_;
  Surroundings surroundings_;
  std::vector<float> sigma_;  // per triangle
  double stroke_m_;
  std::vector<Vector3d> extremes_;
  std::vector<ClosedGrasp> obstructed_;  // what was met on the way of these: for the reason code
  bool slips_ = false;
};

float Planner::sigma(const Triangle& triangle) const {
  if (model_.sigma_m.size() != mesh_.vertices.size()) return 0;
  float sum = 0;
  for (const std::int32_t v : triangle) sum += model_.sigma_m[static_cast<std::size_t>(v)];
  return sum / 3.0F;
}

bool Planner::observed(std::int32_t triangle) const {
  if (model_.states.size() != mesh_.vertices.size()) return false;
  int seen = 0;
  for (const std::int32_t v : mesh_.triangles[static_cast<std::size_t>(triangle)])
    seen += (model_.states[static_cast<std::size_t>(v)] & kVertexObserved) != 0 ? 1 : 0;
  return seen >= 2;
}

/// Whether even the shallowest grip puts the palm into one of the object's extreme points, or a fingertip below the table: a
/// quick look that spares most poses the whole check.
bool Planner::hopeless(const JawPose& pose) const {
  const GripperBoxes boxes = gripper_boxes(gripper_, tcp_frame(pose, least_depth(pose)), pose.width_m, options_.pregrasp_offset_m);
  if (surroundings_.below_support(boxes, options_.scene_clearance_m)) return true;
  return std::any_of(extremes_.begin(), extremes_.end(), [&](const Vector3d& point) {
    return ((boxes.palm.T_box_world * point).cwiseAbs() - boxes.palm.half).maxCoeff() < 0;
  });
}

/// Whether even the shallowest grip puts the palm into the object: contacts farther in than the fingers are long.
bool Planner::palm_meets(const JawPose& pose) const {
  return bvh_.meets(gripper_boxes(gripper_, tcp_frame(pose, least_depth(pose)), pose.width_m, 0).palm);
}

/// Whether the shallowest grip meets table, neighbours or obstacles even with the jaw as little open as it may be.
bool Planner::blocked(const JawPose& pose) {
  ClosedGrasp grasp{pose, tcp_frame(pose, least_depth(pose)), pose.width_m + 2 * kTightClearance * options_.opening_clearance_m, {}, {}, {}};
  if (!surroundings_.blocks(gripper_boxes(gripper_, grasp.T_camera_tcp, grasp.opening_m, options_.pregrasp_offset_m), options_.scene_clearance_m)) return false;
  obstructed_.push_back(grasp);
  return true;
}

std::optional<ClosedGrasp> Planner::try_pose(const JawPose& pose) {
  double last_m = -1;
  for (const double depth_m : {gripper_.pad_depth_m, kShallowDepth * gripper_.pad_depth_m, least_depth(pose)}) {
    if (depth_m == last_m) continue;
    last_m = depth_m;
    for (const double clearance_share : {1.0, kTightClearance}) {
      const double opening_m = pose.width_m + 2 * clearance_share * options_.opening_clearance_m;
      if (opening_m > stroke_m_) continue;
      ClosedGrasp grasp{pose, tcp_frame(pose, depth_m), opening_m, {}, {}, {}};
      const Obstruction met = close(grasp, depth_m);
      if (met == Obstruction::kNone) return grasp;
      if (met != Obstruction::kFingers) break;  // a smaller opening would not help
    }
  }
  return std::nullopt;
}

/// How far the tips reach past the contacts in the shallowest grip: a share of the pad, less where the table is nearer (a
/// spoon is held by the very tips), never less than half a millimetre.
double Planner::least_depth(const JawPose& pose) const {
  const double shallow_m = kShallowDepth * gripper_.pad_depth_m;
  const double downwards = -pose.approach.dot(up_);
  if (downwards < 0.2) return shallow_m;
  const double outer_m = 0.5 * pose.width_m + kTightClearance * options_.opening_clearance_m + gripper_.finger_thickness_m;
  const double drop_m = 0.5 * gripper_.finger_width_m * std::abs(pose.approach.cross(pose.axis).dot(up_)) + outer_m * std::abs(pose.axis.dot(up_));
  const double room_m = (surroundings_.height(pose.middle) - drop_m - options_.scene_clearance_m) / downwards - 1e-5;
  return std::clamp(room_m, std::min(0.0005, shallow_m), shallow_m);
}

Obstruction Planner::obstruction(const ClosedGrasp& grasp, double sweep_m) {
  const GripperBoxes boxes = gripper_boxes(gripper_, grasp.T_camera_tcp, grasp.opening_m, sweep_m);
  if (surroundings_.below_support(boxes, options_.scene_clearance_m) || bvh_.meets(boxes.palm)) return Obstruction::kDepth;
  if (bvh_.meets(boxes.fingers[0]) || bvh_.meets(boxes.fingers[1]) || surroundings_.blocks(boxes, options_.scene_clearance_m))
    return Obstruction::kFingers;
  return Obstruction::kNone;
}

/// Closes the jaw where `grasp` stands, on the fitted mesh, and centres it between its touches.
Obstruction Planner::close(ClosedGrasp& grasp, double depth_m, bool may_align) {
  const Obstruction met = obstruction(grasp, options_.pregrasp_offset_m);
  if (met != Obstruction::kNone) {
    obstructed_.push_back(grasp);
    return met;
  }
  const auto touches = close_jaw(mesh_, bvh_, gripper_, grasp.T_camera_tcp, grasp.opening_m);
  if (!touches) return Obstruction::kSlips;
  grasp.touches = *touches;
  const double off_centre = 0.5 * (grasp.touches[0].point.y() + grasp.touches[1].point.y());
  for (PadTouch& touch : grasp.touches) touch.point.y() -= off_centre;
  grasp.pose.middle += off_centre * grasp.pose.axis;
  grasp.pose.width_m = grasp.touches[0].point.y() - grasp.touches[1].point.y();
  grasp.T_camera_tcp = tcp_frame(grasp.pose, depth_m);
  if (std::abs(off_centre) > 1e-4 && obstruction(grasp, options_.pregrasp_offset_m) != Obstruction::kNone) return Obstruction::kFingers;

  std::array<WrenchContact, 2> contacts;
  for (std::size_t i = 0; i < 2; ++i)
    contacts[i] = {grasp.T_camera_tcp * grasp.touches[i].point, grasp.T_camera_tcp.linear() * grasp.touches[i].normal, gripper_.friction, gripper_.torsion_m};
  grasp.quality = grasp_quality(contacts, scale_);
  if (grasp.quality.force_closure && grasp.quality.epsilon >= options_.min_epsilon) return Obstruction::kNone;
  if (may_align && align(grasp, depth_m)) return Obstruction::kNone;
  slips_ = true;
  return Obstruction::kSlips;
}

/// Turns a jaw that slipped square to what its pads met, and closes it again: long pads on faces that lean a few degrees touch
/// at opposite ends, where a normal of one triangle had seemed good enough.
bool Planner::align(ClosedGrasp& grasp, double depth_m) {
  constexpr double kLeastTurn = 0.9999, kMostTurn = 0.85;  // cosines: under a degree changes nothing, over 30 it is another grasp
  const Vector3d axis = (grasp.T_camera_tcp.linear() * (grasp.touches[1].normal - grasp.touches[0].normal)).normalized();
  const double cosine = axis.dot(grasp.pose.axis);
  if (!(cosine < kLeastTurn && cosine > kMostTurn)) return false;
  ClosedGrasp aligned = grasp;
  aligned.pose.axis = axis;
  aligned.pose.approach = (grasp.pose.approach - axis * axis.dot(grasp.pose.approach)).normalized();
  if (aligned.pose.approach.dot(up_) > 0.05) return false;  // it must not come from below
  aligned.T_camera_tcp = tcp_frame(aligned.pose, depth_m);
  if (close(aligned, depth_m, false) != Obstruction::kNone) return false;
  grasp = aligned;
  return true;
}

void Planner::value(ClosedGrasp& grasp, const std::vector<ShapeDraw>& draws) {
  const JawLine jaw{grasp.pose.middle, grasp.pose.axis, grasp.opening_m};
  grasp.closure = closure_statistics(jaw, draws, bvh_, normals_, sigma_, gripper_.friction, gripper_.torsion_m, scale_, options_.min_epsilon);
  grasp.margin_m = surroundings_.distance(gripper_boxes(gripper_, grasp.T_camera_tcp, grasp.opening_m, options_.pregrasp_offset_m), kMarginLimit);
  // No jaw of this kind can do better than the torsional reach of its own pads.
  const double best_epsilon = gripper_.friction * gripper_.torsion_m / scale_.radius_m;
  const double seen = 0.5 * (observed(grasp.touches[0].triangle) + observed(grasp.touches[1].triangle));
  // The weight turns the object about the closing axis, where only the torsion of the pads holds it.
  const Vector3d to_centre = scale_.centre - grasp.pose.middle;
  const double lever_m = std::abs(to_centre.cross(up_).dot(grasp.pose.axis));
  const double merit = 0.30 * std::min(1.0, grasp.closure.epsilon_lcb / best_epsilon) + 0.25 * std::max(0.0, -grasp.pose.approach.dot(up_)) +
                       0.20 * (1 - std::min(1.0, lever_m / scale_.radius_m)) + 0.10 * seen + 0.15 * std::min(1.0, grasp.margin_m / 0.02);
  const bool around_the_body = std::abs(to_centre.dot(grasp.pose.axis)) < 0.5 * grasp.pose.width_m;
  grasp.score = grasp.closure.p_force_closure * (around_the_body ? 1.0 : kBesideTheBody) * (0.4 + 0.6 * merit);
}

Grasp Planner::published(const ClosedGrasp& closed) const {
  Grasp grasp;
  grasp.T_camera_tcp = closed.T_camera_tcp;
  grasp.T_camera_parent = closed.T_camera_tcp * gripper_.T_tcp_parent;
  grasp.T_camera_pregrasp_tcp = closed.T_camera_tcp * Eigen::Translation3d(-options_.pregrasp_offset_m, 0, 0);
  grasp.gripper = gripper_.name;
  grasp.width_m = closed.pose.width_m;
  grasp.opening_m = closed.opening_m;
  grasp.approach = closed.pose.approach;
  grasp.epsilon = closed.quality.epsilon;
  grasp.volume_quality = closed.quality.volume;
  grasp.force_closure = closed.quality.force_closure;
  grasp.p_force_closure = closed.closure.p_force_closure;
  grasp.epsilon_lcb = closed.closure.epsilon_lcb;
  grasp.collision_margin_m = closed.margin_m;
  grasp.score = closed.score;
  int seen = 0;
  double largest_sigma = -1;
  for (std::size_t i = 0; i < 2; ++i) {
    const PadTouch& touch = closed.touches[i];
    grasp.contacts[i] = {closed.T_camera_tcp * touch.point, closed.T_camera_tcp.linear() * touch.normal, observed(touch.triangle)};
    seen += grasp.contacts[i].observed ? 1 : 0;
    const double uncertainty = sigma_[static_cast<std::size_t>(touch.triangle)] + (grasp.contacts[i].observed ? 0.0 : 1.0);
    if (uncertainty > largest_sigma) {
      largest_sigma = uncertainty;
      grasp.helpful_view = grasp.contacts[i].normal;
    }
  }
  grasp.visibility = std::array{"none", "one", "both"}[static_cast<std::size_t>(seen)];
  grasp.abstain = grasp.p_force_closure < options_.abstain_below_p + (seen == 0 ? 0.2 : 0.0);
  return grasp;
}

/// Adds the poses that hold, in the queue's order, until there are `enough` of them or the effort is spent.
void Planner::close_poses(const std::vector<AntipodalPair>& pairs, int effort, std::size_t enough, std::vector<ClosedGrasp>& closed, int& examined) {
  JawPoseQueue queue(pairs, scale_, up_, options_.approach_angles);
  while (closed.size() < enough && effort > 0) {
    const auto pose = queue.next();
    if (!pose) return;
    ++examined;
    if (std::any_of(closed.begin(), closed.end(), [&](const ClosedGrasp& other) { return alike(*pose, other.pose, 0.010, 0.94); })) continue;
    if (hopeless(*pose)) continue;
    --effort;
    if (palm_meets(*pose)) continue;
    effort -= kSceneCheck;
    if (blocked(*pose)) continue;
    effort -= kWholeCheck;
    if (auto grasp = try_pose(*pose)) closed.push_back(*grasp);
  }
}

/// The reason code of a search in which no pose held. The stroke is to blame where the same gripper with a wider one would hold.
std::string Planner::why_none(const PairSearch& search) {
  const bool reached = std::any_of(obstructed_.begin(), obstructed_.end(), [&](const ClosedGrasp& grasp) { return obstruction(grasp, 0) == Obstruction::kNone; });
  const std::string reason = slips_ ? "not_force_closure" : reached ? "unreachable" : "all_in_collision";
  stroke_m_ = kWidestStroke;
  std::vector<ClosedGrasp> wider;
  int examined = 0;
  close_poses(search.too_wide, kWiderEffort, 1, wider, examined);
  return wider.empty() ? reason : "too_wide";
}

GraspPlan Planner::plan() {
  const double widest_m = gripper_.stroke_m - 2 * kTightClearance * options_.opening_clearance_m;
  PairSearch search = find_antipodal_pairs(model_, mesh_, normals_, bvh_, gripper_.friction, gripper_.min_width_m, widest_m, options_);
  if (search.pairs.empty()) return {{}, search.too_wide.empty() ? "no_antipodal_pair" : "too_wide", 0};

  // Grips around the body are looked for first, then those of a rim or a handle, so that neither crowds out the other.
  const auto beside = std::stable_partition(search.pairs.begin(), search.pairs.end(), [&](const AntipodalPair& pair) { return pair.spans(scale_.centre); });
  const std::vector<AntipodalPair> around(search.pairs.begin(), beside), edges(beside, search.pairs.end());
  const auto wanted = static_cast<std::size_t>(options_.max_grasps);
  const std::size_t enough = wanted + wanted / 2;  // some fall to their neighbours in the list, or to uncertainty
  std::vector<ClosedGrasp> closed;
  GraspPlan plan;
  close_poses(around, kBodyEffort, enough - enough / 4, closed, plan.poses_examined);
  close_poses(edges, kEdgeEffort, enough, closed, plan.poses_examined);
  if (closed.empty()) {
    plan.no_grasp_reason = why_none(search);
    return plan;
  }

  const std::vector<ShapeDraw> draws = draw_shapes(model_, options_.uncertainty_samples, options_.seed);
  for (ClosedGrasp& grasp : closed) value(grasp, draws);
  std::stable_sort(closed.begin(), closed.end(), [](const ClosedGrasp& a, const ClosedGrasp& b) { return a.score > b.score; });
  std::vector<JawPose> taken;
  for (const ClosedGrasp& grasp : closed) {
    if (plan.grasps.size() == wanted) break;
    if (std::any_of(taken.begin(), taken.end(), [&](const JawPose& other) { return alike(grasp.pose, other, 0.015, 0.906); })) continue;
    taken.push_back(grasp.pose);
    plan.grasps.push_back(published(grasp));
  }
  return plan;
}

}  // namespace

GraspPlan plan_grasps(const FittedModel& model, const GraspScene& scene, const Gripper& gripper, const PlanGraspsOptions& options) {
  if (options.max_grasps == 0) return {{}, "not_planned", 0};
  if (model.vertices.empty() || model.topology->triangles.empty()) return {{}, "no_antipodal_pair", 0};
  return Planner(model, scene, gripper, options).plan();
}

}  // namespace gfp
