#include "wire/scene_messages.hpp"

#include <fmt/format.h>

#include "wire/bounded_parse.hpp"
#include "wire/geometry_messages.hpp"
#include "wire/grasp_messages.hpp"

namespace gfp::wire {
namespace {

static_assert(static_cast<int>(ObjectStatus::kUpdated) == v1::SceneObject::STATUS_UPDATED);
static_assert(static_cast<int>(ObjectStatus::kLost) == v1::SceneObject::STATUS_LOST);

using ProtoMap = google::protobuf::Map<std::string, double>;

void fill(const std::map<std::string, double>& values, ProtoMap& message) {
  for (const auto& [name, value] : values) message[name] = value;
}

std::map<std::string, double> map_from(const ProtoMap& message) { return {message.begin(), message.end()}; }

void fill(const SupportPlane& support, v1::Support& message) {
  wire::fill(support.T_camera_support, *message.mutable_t_camera_support());
  for (const Eigen::Vector2d& corner : support.polygon) {
    message.add_polygon(corner.x());
    message.add_polygon(corner.y());
  }
  message.set_rms_m(support.rms_m);
  message.set_inliers(static_cast<std::uint32_t>(support.inliers));
}

Result<SupportPlane> support_from(const v1::Support& message) {
  const auto pose = transform_from(message.t_camera_support(), "support.T_camera_support");
  if (!pose) return tl::unexpected(pose.error());
  if (message.polygon_size() % 2 != 0 || message.polygon_size() > kMaxListItems)
    return failure(ErrorCode::kCorruptData, fmt::format("support.polygon has {} numbers, expected pairs", message.polygon_size()));
  SupportPlane support;
  support.T_camera_support = *pose;
  for (int i = 0; i < message.polygon_size(); i += 2) support.polygon.emplace_back(message.polygon(i), message.polygon(i + 1));
  support.rms_m = message.rms_m();
  support.inliers = static_cast<int>(message.inliers());
  return support;
}

void fill(const FitEvidence& evidence, v1::Evidence& message) {
  message.set_rms_m(evidence.rms_m);
  message.set_fit_similarity(evidence.fit_similarity);
  message.set_explained(evidence.explained);
  message.set_free_space_violation(evidence.free_space_violation);
  message.set_silhouette_iou(evidence.silhouette_iou);
  message.set_below_support_m(evidence.below_support_m);
  message.set_neighbour_overlap_m(evidence.neighbour_overlap_m);
  message.set_mahalanobis(evidence.mahalanobis);
  message.set_context(evidence.context);
  message.set_cost(evidence.cost);
}

FitEvidence evidence_from(const v1::Evidence& message) {
  return {message.rms_m(),           message.fit_similarity(),      message.explained(),   message.free_space_violation(), message.silhouette_iou(),
          message.below_support_m(), message.neighbour_overlap_m(), message.mahalanobis(), message.context(), message.cost()};
}

void fill_model(const FittedModel& model, VertexCoding coding, v1::SceneObject& message) {
  message.set_class_name(model.class_name);
  message.set_method(model.method);
  wire::fill(model.T_camera_object, *message.mutable_t_camera_object());
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) message.add_pose_covariance(model.pose_covariance(row, column));
  message.set_yaw_low_rad(model.yaw_low_rad);
  message.set_yaw_high_rad(model.yaw_high_rad);
  wire::fill(model.size_m, *message.mutable_size_m());
  wire::fill(model.vertices.empty() ? Eigen::Vector3d(0, 0, 0) : bounds(model.vertices).size(), *message.mutable_extents_m());
  message.mutable_modes()->Assign(model.modes.begin(), model.modes.end());
  message.set_stable_pose(static_cast<std::uint32_t>(model.stable_pose));
  wire::fill(model, coding, *message.mutable_vertices());
  fill(model.evidence, *message.mutable_evidence());
  message.set_converged(model.converged);
  message.set_iterations(static_cast<std::uint32_t>(model.iterations));
  message.mutable_energies()->Add(model.energies.begin(), model.energies.end());
  if (model.primitive) message.set_primitive(model.primitive->name);
}

std::shared_ptr<const Topology> topology_without_triangles(std::uint64_t hash) {
  auto topology = std::make_shared<Topology>();
  topology->hash = hash;
  return topology;
}

Result<FittedModel> model_from(const v1::SceneObject& message, const TopologyLookup& topologies) {
  const auto pose = transform_from(message.t_camera_object(), "object.T_camera_object");
  if (!pose) return tl::unexpected(pose.error());
  if (message.pose_covariance_size() != 36)
    return failure(ErrorCode::kCorruptData, fmt::format("object.pose_covariance has {} numbers, expected 36", message.pose_covariance_size()));
  if (message.modes_size() > kMaxListItems || message.energies_size() > kMaxListItems)
    return failure(ErrorCode::kTooLarge, fmt::format("object.modes has {} numbers, object.energies {}, at most {} are read", message.modes_size(), message.energies_size(), kMaxListItems));
  auto vertices = vertices_from(message.vertices());
  if (!vertices) return tl::unexpected(vertices.error());
  FittedModel model;
  model.class_name = message.class_name();
  model.method = message.method();
  model.T_camera_object = *pose;
  for (int i = 0; i < 36; ++i) model.pose_covariance(i / 6, i % 6) = message.pose_covariance(i);
  model.yaw_low_rad = message.yaw_low_rad();
  model.yaw_high_rad = message.yaw_high_rad();
  model.size_m = vector_from(message.size_m());
  model.modes.assign(message.modes().begin(), message.modes().end());
  model.stable_pose = static_cast<int>(message.stable_pose());
  model.vertices = std::move(vertices->positions);
  model.states = std::move(vertices->states);
  model.sigma_m = std::move(vertices->sigma_m);
  model.evidence = evidence_from(message.evidence());
  model.converged = message.converged();
  model.iterations = static_cast<int>(message.iterations());
  model.energies.assign(message.energies().begin(), message.energies().end());
  model.topology = topologies ? topologies(message.vertices().topology_hash()) : nullptr;
  if (!model.topology) model.topology = topology_without_triangles(message.vertices().topology_hash());
  // The topology was checked against its own count: this object must have as many vertices, or triangles would point beyond them.
  for (const Triangle& triangle : model.topology->triangles)
    for (const std::int32_t index : triangle)
      if (static_cast<std::size_t>(index) >= model.vertices.size())
        return failure(ErrorCode::kCorruptData, fmt::format("object {} has {} vertices, its topology names vertex {}", message.id(), model.vertices.size(), index));
  return model;
}

}  // namespace

void fill(const SceneObject& object, VertexCoding coding, v1::SceneObject& message) {
  message.set_id(object.id);
  message.set_status(static_cast<v1::SceneObject::Status>(object.status));
  fill(object.class_probabilities, *message.mutable_class_probabilities());
  fill_model(object.model, coding, message);
  message.set_volume_material_m3(object.volume_material_m3);
  message.set_volume_filled_m3(object.volume_filled_m3);
  message.set_closed(object.closed);
  message.set_self_intersections(static_cast<std::uint32_t>(object.self_intersections));
  message.set_pixels(static_cast<std::uint32_t>(object.pixels));
  for (const int edge : {object.bbox.u0, object.bbox.v0, object.bbox.u1, object.bbox.v1}) message.add_bbox_px(static_cast<std::uint32_t>(edge));
  message.set_touches_border(object.touches_border);
  message.set_occluded(object.occluded);
  message.set_fresh(object.fresh);
  for (const Grasp& grasp : object.grasps.grasps) wire::fill(grasp, *message.add_grasps());
  message.set_no_grasp_reason(object.grasps.no_grasp_reason);
  fill(object.ms, *message.mutable_ms());
}

void fill(const Scene& scene, VertexCoding coding, v1::Scene& message) {
  fill(scene.sensor, scene.sequence, scene.stamps, *message.mutable_header());
  fill(scene.camera, *message.mutable_camera());
  fill(scene.T_world_sensor, *message.mutable_t_world_sensor());
  if (scene.support) fill(*scene.support, *message.mutable_support());
  for (const SceneObject& object : scene.objects) fill(object, coding, *message.add_objects());
  message.mutable_lost()->Assign(scene.lost.begin(), scene.lost.end());
  for (const RejectedSegment& segment : scene.rejected) {
    message.add_rejected()->set_pixels(static_cast<std::uint32_t>(segment.pixels));
    message.mutable_rejected()->rbegin()->set_reason(segment.reason);
  }
  message.set_profile(scene.profile);
  fill(scene.ms, *message.mutable_ms());
}

void fill(const Scene& scene, const SceneObject& object, VertexCoding coding, v1::ObjectUpdate& message) {
  fill(scene.sensor, scene.sequence, scene.stamps, *message.mutable_header());
  fill(object, coding, *message.mutable_object());
  fill(scene.T_world_sensor, *message.mutable_t_world_sensor());
  if (scene.support) fill(*scene.support, *message.mutable_support());
}

void fill_lost(const Scene& scene, std::uint64_t id, v1::ObjectUpdate& message) {
  fill(scene.sensor, scene.sequence, scene.stamps, *message.mutable_header());
  message.mutable_object()->set_id(id);
  message.mutable_object()->set_status(v1::SceneObject::STATUS_LOST);
}

Result<SceneObject> object_from(const v1::SceneObject& message, const TopologyLookup& topologies) {
  SceneObject object;
  object.id = message.id();
  object.status = static_cast<ObjectStatus>(std::clamp<int>(message.status(), 0, v1::SceneObject::STATUS_LOST));
  if (object.status == ObjectStatus::kLost) {
    object.model.topology = topology_without_triangles(0);
    return object;
  }
  if (message.grasps_size() > kMaxGrasps || message.bbox_px_size() != 4)
    return failure(ErrorCode::kCorruptData, fmt::format("object {} has {} grasps (at most {}) and a box of {} numbers (expected 4)", message.id(),
                                                        message.grasps_size(), kMaxGrasps, message.bbox_px_size()));
  auto model = model_from(message, topologies);
  if (!model) return tl::unexpected(model.error());
  object.model = std::move(*model);
  object.class_probabilities = map_from(message.class_probabilities());
  object.volume_material_m3 = message.volume_material_m3();
  object.volume_filled_m3 = message.volume_filled_m3();
  object.closed = message.closed();
  object.self_intersections = static_cast<int>(message.self_intersections());
  object.pixels = static_cast<int>(message.pixels());
  object.bbox = {static_cast<int>(message.bbox_px(0)), static_cast<int>(message.bbox_px(1)), static_cast<int>(message.bbox_px(2)),
                 static_cast<int>(message.bbox_px(3))};
  object.touches_border = message.touches_border();
  object.occluded = message.occluded();
  object.fresh = message.fresh();
  for (const v1::Grasp& sent : message.grasps()) {
    auto grasp = grasp_from(sent);
    if (!grasp) return tl::unexpected(grasp.error());
    object.grasps.grasps.push_back(std::move(*grasp));
  }
  object.grasps.no_grasp_reason = message.no_grasp_reason();
  object.ms = map_from(message.ms());
  return object;
}

Result<Scene> scene_from(const v1::Scene& message, const TopologyLookup& topologies) {
  if (message.objects_size() > kMaxObjects || message.rejected_size() > kMaxListItems || message.lost_size() > kMaxListItems)
    return failure(ErrorCode::kTooLarge, fmt::format("scene has {} objects, {} lost and {} rejected, at most {}, {} and {} are read", message.objects_size(),
                                                     message.lost_size(), message.rejected_size(), kMaxObjects, kMaxListItems, kMaxListItems));
  Scene scene;
  scene.sensor = message.header().sensor();
  scene.sequence = message.header().sequence();
  scene.stamps = stamps_from(message.header());
  auto camera = camera_from(message.camera());
  if (!camera) return tl::unexpected(camera.error());
  scene.camera = std::move(*camera);
  const auto pose = transform_from(message.t_world_sensor(), "scene.T_world_sensor");
  if (!pose) return tl::unexpected(pose.error());
  scene.T_world_sensor = *pose;
  if (message.has_support()) {
    auto support = support_from(message.support());
    if (!support) return tl::unexpected(support.error());
    scene.support = std::move(*support);
  }
  for (const v1::SceneObject& sent : message.objects()) {
    auto object = object_from(sent, topologies);
    if (!object) return tl::unexpected(object.error());
    scene.objects.push_back(std::move(*object));
  }
  scene.lost.assign(message.lost().begin(), message.lost().end());
  for (const v1::RejectedSegment& segment : message.rejected()) scene.rejected.push_back({static_cast<int>(segment.pixels()), segment.reason()});
  scene.profile = message.profile();
  scene.ms = map_from(message.ms());
  return scene;
}

}  // namespace gfp::wire
