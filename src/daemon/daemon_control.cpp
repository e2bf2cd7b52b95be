// What the daemon answers to control requests: fits, grasps that the robot reaches, parameters, control points by hand, the recorder.
#include <fmt/format.h>

#include "daemon/daemon.hpp"
#include "wire/geometry_messages.hpp"
#include "wire/grasp_messages.hpp"
#include "wire/scene_messages.hpp"

namespace gfp {
namespace {

using Reply = v1::ControlReply;

const char* state_of(const Recorder::Status& status) {
  using State = RecordingStatus::State;
  if (status.mode == "off") return "off";
  if (status.recording.state == State::kNoSpace) return "no_space";
  if (status.recording.state == State::kFailing) return "failing";
  return status.mode == "ring" && status.recording.state == State::kIdle ? "ring" : "recording";
}

Reply::Code code_of(ErrorCode code) {
  if (code == ErrorCode::kNotFound) return Reply::CODE_NOT_FOUND;
  return code == ErrorCode::kIo ? Reply::CODE_UNAVAILABLE : Reply::CODE_INVALID;
}

/// The entry of the sensor that is named, or of the only one.
template <class T>
const T* entry_of(const std::map<std::string, T>& entries, const std::string& sensor) {
  if (sensor.empty()) return entries.size() == 1 ? &entries.begin()->second : nullptr;
  const auto found = entries.find(sensor);
  return found == entries.end() ? nullptr : &found->second;
}

Reply no_sensor(const v1::ControlRequest& request, const std::string& sensor) {
  if (sensor.empty()) return refusal(request, Reply::CODE_NOT_FOUND, "sensor is empty, expected a name: none or several have delivered frames");
  return refusal(request, Reply::CODE_NOT_FOUND, fmt::format("sensor = {}, which has not delivered a frame", sensor));
}

/// u0 v0 u1 v1, half-open.
bool holds(const google::protobuf::RepeatedField<std::uint32_t>& region, const PixelRect& box) {
  if (region.empty()) return true;
  const auto inside = [](double low, double high, double value) { return low <= value && value < high; };
  return inside(region[0], region[2], 0.5 * (box.u0 + box.u1)) && inside(region[1], region[3], 0.5 * (box.v0 + box.v1));
}

Reply parameters_reply(const DaemonOptions& options, const google::protobuf::RepeatedPtrField<std::string>& prefixes) {
  Reply reply;
  auto& values = *reply.mutable_parameters()->mutable_values();
  for (const auto& [path, value] : config::parameters(options)) {
    const bool is_wanted = prefixes.empty() || std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) { return path.starts_with(prefix); });
    if (is_wanted) values[path] = value;
  }
  return reply;
}

}  // namespace

Reply Daemon::answer(const v1::ControlRequest& request) {
  if (request.has_fit()) return answer_fit(request);
  if (request.has_grasp()) return answer_grasp(request);
  if (request.has_get_parameters()) {
    MutexLock lock(mutex_);
    return parameters_reply(options_, request.get_parameters().prefixes());
  }
  if (request.has_retype()) return answer_retype(request);
  if (request.has_record()) return answer_record(request);
  return answer_set_parameters(request);
}

Reply Daemon::answer_fit(const v1::ControlRequest& request) {
  const auto& region = request.fit().region_px();
  if (region.size() != 0 && region.size() != 4) return refusal(request, Reply::CODE_INVALID, fmt::format("region_px has {} numbers, expected u0 v0 u1 v1", region.size()));
  FramePtr frame;
  std::shared_ptr<const PipelineOptions> options;
  {
    MutexLock lock(mutex_);
    const FramePtr* last = entry_of(last_frames_, request.fit().sensor());
    if (last == nullptr) return no_sensor(request, request.fit().sensor());
    frame = *last;
    options = pipeline_options_;
  }
  Scene scene = parts_.process(*frame, {}, *options).scene;
  std::erase_if(scene.objects, [&](const SceneObject& object) { return !holds(region, object.bbox); });
  Reply reply;
  v1::Fit& fit = *reply.mutable_fit();
  wire::fill(scene, wire::VertexCoding::kFloat32, *fit.mutable_scene());
  std::set<std::uint64_t> told;
  for (const SceneObject& object : scene.objects)
    if (object.model.topology && told.insert(object.model.topology->hash).second) wire::fill(*object.model.topology, object.model.vertices.size(), *fit.add_topologies());
  return reply;
}

Reply Daemon::answer_grasp(const v1::ControlRequest& request) {
  const std::uint64_t id = request.grasp().object();
  ScenePtr scene;
  RobotOptions robot;
  {
    MutexLock lock(mutex_);
    const ScenePtr* last = entry_of(last_scenes_, request.grasp().sensor());
    if (last == nullptr) return no_sensor(request, request.grasp().sensor());
    scene = *last;
    robot = options_.robot;
  }
  const auto object = std::find_if(scene->objects.begin(), scene->objects.end(), [&](const SceneObject& one) { return one.id == id; });
  if (object == scene->objects.end()) return refusal(request, Reply::CODE_NOT_FOUND, fmt::format("object = {}, which is not in the last scene", id));
  if (object->grasps.grasps.empty()) return refusal(request, Reply::CODE_NOT_FOUND, fmt::format("object {} has no grasp: {}", id, object->grasps.no_grasp_reason));
  const Transform T_base_camera = robot.T_world_base.inverse() * scene->T_world_sensor;
  const auto reaches = [&](const Transform& T_camera_tcp) {
    const double distance_m = (T_base_camera * T_camera_tcp).translation().norm();
    return robot.min_reach_m <= distance_m && distance_m <= robot.max_reach_m;
  };
  for (const Grasp& grasp : object->grasps.grasps) {  // best first
    if (grasp.abstain || !reaches(grasp.T_camera_tcp) || !reaches(grasp.T_camera_pregrasp_tcp)) continue;
    Reply reply;
    v1::ReachableGrasp& found = *reply.mutable_grasp();
    wire::fill(grasp, *found.mutable_grasp());
    wire::fill(T_base_camera * grasp.T_camera_tcp, *found.mutable_t_base_tcp());
    wire::fill(T_base_camera * grasp.T_camera_parent, *found.mutable_t_base_parent());
    wire::fill(T_base_camera * grasp.T_camera_pregrasp_tcp, *found.mutable_t_base_pregrasp_tcp());
    wire::fill(scene->sensor, scene->sequence, scene->stamps, *found.mutable_header());
    return reply;
  }
  return refusal(request, Reply::CODE_NOT_FOUND,
                 fmt::format("none of the {} grasps of object {} is sure enough and within {} to {} m of the robot's base", object->grasps.grasps.size(), id, robot.min_reach_m, robot.max_reach_m));
}

Reply Daemon::answer_retype(const v1::ControlRequest& request) const {
  const v1::RetypeRequest& asked = request.retype();
  std::optional<PointType> type;
  if (asked.type() == v1::RetypeRequest::TYPE_REGULAR) type = PointType::kRegular;
  else if (asked.type() == v1::RetypeRequest::TYPE_CONTROL) type = PointType::kControl;
  else if (asked.type() != v1::RetypeRequest::TYPE_AUTOMATIC) return refusal(request, Reply::CODE_INVALID, fmt::format("type = {}, expected 0 to 2", static_cast<int>(asked.type())));
  const auto done = parts_.retype(asked.primitive(), {asked.vertices().begin(), asked.vertices().end()}, type);
  if (!done) return refusal(request, code_of(done.error().code), done.error().what);
  Reply reply;
  v1::Retyped& retyped = *reply.mutable_retyped();
  retyped.set_primitive(done->name);
  retyped.set_file(done->file);
  retyped.set_changed(static_cast<std::uint32_t>(done->changed));
  for (const PointType one : done->types) retyped.mutable_types()->push_back(one == PointType::kControl ? '\1' : '\0');
  for (const std::optional<PointType>& manual : done->manual) retyped.mutable_manual_types()->push_back(!manual ? '\0' : *manual == PointType::kRegular ? '\1' : '\2');
  retyped.mutable_manual_types()->resize(done->types.size(), '\0');  // nothing by hand: none is listed
  return reply;
}

Reply Daemon::answer_record(const v1::ControlRequest& request) {
  const v1::RecordRequest::Action asked = request.record().action();
  if (!v1::RecordRequest::Action_IsValid(asked)) return refusal(request, Reply::CODE_INVALID, fmt::format("action = {}, expected 0 to 3", static_cast<int>(asked)));
  static_assert(static_cast<int>(Recorder::Action::kTrigger) == static_cast<int>(v1::RecordRequest::ACTION_TRIGGER));
  const auto status = recorder_->control(static_cast<Recorder::Action>(asked));
  if (!status) return refusal(request, status.error().code == ErrorCode::kTimeout ? Reply::CODE_UNAVAILABLE : Reply::CODE_INVALID, status.error().what);
  Reply reply;
  v1::Recording& recording = *reply.mutable_recording();
  {
    MutexLock lock(mutex_);
    recording.set_mode(options_.recording.mode);
  }
  recording.set_state(state_of(*status));
  recording.set_file(status->recording.file.string());
  recording.set_files(status->recording.files);
  recording.set_messages(status->recording.messages);
  recording.set_bytes(status->recording.bytes);
  recording.set_lost_messages(status->recording.lost_messages);
  recording.set_last_error(status->recording.last_error);
  return reply;
}

Reply Daemon::answer_set_parameters(const v1::ControlRequest& request) {
  std::vector<std::string> settings;
  for (const auto& [path, value] : request.set_parameters().values()) {
    if (!path.starts_with("pipeline.")) return refusal(request, Reply::CODE_INVALID, fmt::format("{}: only what is below pipeline. can be changed while the daemon runs", path));
    settings.push_back(path + "=" + value);
  }
  std::sort(settings.begin(), settings.end());
  MutexLock lock(mutex_);
  auto changed = config::with_settings(options_, settings);
  if (!changed) return refusal(request, Reply::CODE_INVALID, changed.error().what);
  if (const auto valid = validate(changed->pipeline); !valid) return refusal(request, Reply::CODE_INVALID, valid.error().what);
  options_ = std::move(*changed);
  pipeline_options_ = std::make_shared<const PipelineOptions>(options_.pipeline);
  google::protobuf::RepeatedPtrField<std::string> prefixes;
  for (const auto& [path, value] : request.set_parameters().values()) prefixes.Add(std::string(path));
  return parameters_reply(options_, prefixes);
}

}  // namespace gfp
