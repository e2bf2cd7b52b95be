#include "wire/scene_json.hpp"

#include <algorithm>
#include <vector>

namespace gfp {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

template <class Matrix>
Json matrix_json(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json map_json(const std::map<std::string, double>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

double median_sigma_mm(std::vector<float> sigma_m) {
  if (sigma_m.empty()) return 0;
  const auto middle = sigma_m.begin() + static_cast<std::ptrdiff_t>(sigma_m.size() / 2);
  std::nth_element(sigma_m.begin(), middle, sigma_m.end());
  return 1e3 * static_cast<double>(*middle);
}

double observed_fraction(const std::vector<std::uint8_t>& states) {
  if (states.empty()) return 0;
  const auto observed = std::count_if(states.begin(), states.end(), [](std::uint8_t state) { return (state & kVertexObserved) != 0; });
  return static_cast<double>(observed) / static_cast<double>(states.size());
}

Json evidence_json(const FitEvidence& evidence) {
  return {{"explained", evidence.explained},
          {"free_space_violation", evidence.free_space_violation},
          {"silhouette_iou", evidence.silhouette_iou},
          {"below_support_mm", 1e3 * evidence.below_support_m},
          {"neighbour_overlap_mm", 1e3 * evidence.neighbour_overlap_m},
          {"mahalanobis", evidence.mahalanobis},
          {"context", evidence.context},
          {"cost", evidence.cost}};
}

/// How a contour ran, and what of it data moved (P27, Fig. 6 of the paper): energies iteration by iteration, the start first.
Json contour_json(const FittedModel& model) {
  int controls = 0, moved_controls = 0, moved_regulars = 0;
  for (const std::uint8_t state : model.states) {
    const bool control = (state & kVertexControl) != 0, moved = (state & kVertexMoved) != 0;
    controls += control ? 1 : 0;
    moved_controls += control && moved ? 1 : 0;
    moved_regulars += !control && moved ? 1 : 0;
  }
  return {{"iterations", model.iterations}, {"converged", model.converged}, {"energies", model.energies}, {"controls", controls},
          {"moved_controls", moved_controls}, {"moved_regulars", moved_regulars}, {"frozen_controls", controls - moved_controls}};
}

const char* status_name(ObjectStatus status) {
  switch (status) {
    case ObjectStatus::kAdded: return "added";
    case ObjectStatus::kUpdated: return "updated";
    case ObjectStatus::kUnchanged: return "unchanged";
    case ObjectStatus::kLost: return "lost";
  }
  return "unknown";
}

}  // namespace

nlohmann::ordered_json grasp_json(const Grasp& grasp) {
  Json contacts = Json::array();
  for (const GraspContact& contact : grasp.contacts)
    contacts.push_back({{"point", vector_json(contact.point)}, {"normal", vector_json(contact.normal)}, {"observed", contact.observed}});
  return {{"T_camera_tcp", matrix_json(grasp.T_camera_tcp.matrix())},
          {"T_camera_parent", matrix_json(grasp.T_camera_parent.matrix())},
          {"T_camera_pregrasp_tcp", matrix_json(grasp.T_camera_pregrasp_tcp.matrix())},
          {"gripper", grasp.gripper},
          {"width_m", grasp.width_m},
          {"approach", vector_json(grasp.approach)},
          {"epsilon", grasp.epsilon},
          {"volume_quality", grasp.volume_quality},
          {"force_closure", grasp.force_closure},
          {"p_force_closure", grasp.p_force_closure},
          {"epsilon_lcb", grasp.epsilon_lcb},
          {"contacts", std::move(contacts)},
          {"collision_margin_m", grasp.collision_margin_m},
          {"visibility", grasp.visibility},
          {"abstain", grasp.abstain},
          {"score", grasp.score}};
}

nlohmann::ordered_json object_json(const SceneObject& object, const std::string& mesh_file) {
  const FittedModel& model = object.model;
  const Eigen::Vector3d extents = model.vertices.empty() ? Eigen::Vector3d(0, 0, 0) : bounds(model.vertices).size();
  Json grasps = Json::array();
  for (const Grasp& grasp : object.grasps.grasps) grasps.push_back(grasp_json(grasp));
  Json json = {{"id", object.id},
               {"class", model.class_name},
               {"class_probabilities", map_json(object.class_probabilities)},
               {"method", model.method},
               {"status", status_name(object.status)},
               {"T_camera_object", matrix_json(model.T_camera_object.matrix())},
               {"scale", vector_json(model.size_m)},
               {"extents_m", vector_json(extents)},
               {"pose_covariance", matrix_json(model.pose_covariance)},
               {"yaw_interval_rad", {model.yaw_low_rad, model.yaw_high_rad}},
               {"pixels", object.pixels},
               {"bbox_px", {object.bbox.u0, object.bbox.v0, object.bbox.u1, object.bbox.v1}},
               {"touches_border", object.touches_border},
               {"occluded", object.occluded},
               {"fresh", object.fresh},
               {"vertices", model.vertices.size()},
               {"triangles", model.topology ? model.topology->triangles.size() : 0},
               {"closed", object.closed},
               {"self_intersections", object.self_intersections},
               {"volume_material_m3", object.volume_material_m3},
               {"volume_filled_m3", object.volume_filled_m3},
               {"fit_similarity", model.evidence.fit_similarity},
               {"rms_mm", 1e3 * model.evidence.rms_m},
               {"observed_fraction", observed_fraction(model.states)},
               {"sigma_median_mm", median_sigma_mm(model.sigma_m)},
               {"evidence", evidence_json(model.evidence)}};
  if (!model.energies.empty()) json["evidence"]["contour"] = contour_json(model);
  json["mesh"] = mesh_file.empty() ? Json(nullptr) : Json(mesh_file);
  json["no_grasp_reason"] = object.grasps.no_grasp_reason.empty() ? Json(nullptr) : Json(object.grasps.no_grasp_reason);
  json["grasps"] = std::move(grasps);
  json["ms"] = map_json(object.ms);
  return json;
}

nlohmann::ordered_json scene_json(const Scene& scene, const SceneJsonContext& context) {
  Json support = nullptr;
  if (scene.support)
    support = {{"T_camera_support", matrix_json(scene.support->T_camera_support.matrix())},
               {"rms_mm", 1e3 * scene.support->rms_m},
               {"inliers", scene.support->inliers}};
  Json rejected = Json::array();
  for (const RejectedSegment& segment : scene.rejected) rejected.push_back({{"pixels", segment.pixels}, {"reason", segment.reason}});
  Json objects = Json::array();
  for (const SceneObject& object : scene.objects) {
    const auto mesh = context.meshes.find(object.id);
    objects.push_back(object_json(object, mesh == context.meshes.end() ? std::string() : mesh->second));
  }
  return {{"input", context.input},
          {"frame", scene.sequence},
          {"stamp_ns", scene.stamps.sensor.count()},
          {"sensor", scene.sensor},
          {"profile", scene.profile},
          {"method", context.method},
          {"support", std::move(support)},
          {"ms", map_json(scene.ms)},
          {"rejected", std::move(rejected)},
          {"lost", scene.lost},
          {"objects", std::move(objects)}};
}

}  // namespace gfp
