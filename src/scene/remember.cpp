#include "gfp/scene/remember.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace gfp {
namespace {

const Track* find_track(const SceneMemory& memory, std::uint64_t id) {
  for (const Track& track : memory.tracks)
    if (track.id == id) return &track;
  return nullptr;
}

const SceneObject* find_object(const Scene& scene, std::uint64_t id) {
  for (const SceneObject& object : scene.objects)
    if (object.id == id) return &object;
  return nullptr;
}

bool seen(const std::vector<ObjectView>& views, std::uint64_t id) {
  return std::any_of(views.begin(), views.end(), [&](const ObjectView& view) { return view.id == id; });
}

/// Pixels and place of what was seen.
void locate(Track& track, const ObjectView& view, const Scene& scene) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  track.bbox = {view.tile.u1, view.tile.v1, view.tile.u0, view.tile.v0};
  track.pixels.clear();
  track.pixels.reserve(static_cast<std::size_t>(view.object_pixels));
  for (int v = view.tile.v0; v < view.tile.v1; ++v) {
    for (int u = view.tile.u0; u < view.tile.u1; ++u) {
      const int i = u - view.tile.u0, j = v - view.tile.v0;
      if (view.evidence.at(i, j) != Evidence::kObject) continue;
      track.pixels.push_back(v * view.camera.width + u);
      track.bbox = {std::min(track.bbox.u0, u), std::min(track.bbox.v0, v), std::max(track.bbox.u1, u + 1), std::max(track.bbox.v1, v + 1)};
      sum += view.camera.ray(u, v) * static_cast<double>(view.depth_m.at(i, j));
    }
  }
  track.centre_world = scene.T_world_sensor * Eigen::Vector3d(sum / std::max(1, view.object_pixels));
  track.height_m = view.height_m;
  track.sensor = scene.sensor;
  track.T_world_sensor = scene.T_world_sensor;
  track.missed_frames = 0;
}

WarmStart warm_start_of(const SceneObject& object, const WarmStart& before) {
  const FittedModel& model = object.model;
  const bool unchanged = object.status == ObjectStatus::kUnchanged;
  WarmStart warm;
  warm.primitive = model.primitive ? model.primitive->name : "";
  warm.method = model.method;
  warm.T_camera_object = model.T_camera_object;
  warm.scale = model.size_m;
  warm.modes = model.modes;
  warm.stable_pose = model.stable_pose;
  warm.cost = model.evidence.cost;
  warm.unchanged_frames = unchanged ? before.unchanged_frames + 1 : 0;
  warm.fits = unchanged ? before.fits : before.fits + 1;
  return warm;
}

Track next_track(const ObjectView& view, const Scene& scene, const Track* before) {
  Track track = before ? *before : Track{};
  track.id = view.id;
  locate(track, view, scene);
  const SceneObject* object = find_object(scene, view.id);
  if (!object) {  // seen, but nothing could be fitted to it
    track.fit = {};
    track.fitted_view.reset();
    track.object.reset();
    return track;
  }
  track.fit = warm_start_of(*object, track.fit);
  if (object->status != ObjectStatus::kUnchanged || !track.fitted_view) track.fitted_view = std::make_shared<const ObjectView>(view);
  track.object = std::make_shared<const SceneObject>(*object);
  track.fit.model = std::shared_ptr<const FittedModel>(track.object, &track.object->model);
  return track;
}

/// Nothing where the frame is none: a depth image that does not fit its camera has no second look.
std::shared_ptr<const Look> look_at(const Frame& frame, const Scene& scene) {
  if (frame.depth.pixels.width != frame.camera.width || frame.depth.pixels.height != frame.camera.height || !validate(frame.camera)) return nullptr;
  auto look = std::make_shared<Look>();
  look->frame.sensor = frame.sensor;
  look->frame.depth = frame.depth;
  look->frame.camera = frame.camera;
  look->frame.noise = frame.noise;
  look->frame.T_world_sensor = frame.T_world_sensor;
  look->frame.up_camera = frame.up_camera;
  look->frame.mask = frame.mask;
  look->support = scene.support;
  look->rejected = scene.rejected;
  return look;
}

bool stands_there(const Track& track, const std::string& sensor) { return track.sensor == sensor && track.missed_frames == 0 && track.object; }

}  // namespace

std::vector<std::uint64_t> lost_ids(const SceneMemory& memory, const std::vector<ObjectView>& views, const std::string& sensor) {
  std::vector<std::uint64_t> lost;
  for (const Track& track : memory.tracks)
    if (stands_there(track, sensor) && !seen(views, track.id)) lost.push_back(track.id);
  return lost;
}

Scene standing_scene(const SceneMemory& memory, const std::string& sensor) {
  Scene scene;
  scene.support = memory.look->support;
  scene.rejected = memory.look->rejected;
  for (const Track& track : memory.tracks) {
    if (!stands_there(track, sensor)) continue;
    scene.objects.push_back(*track.object);
    scene.objects.back().status = ObjectStatus::kUnchanged;
    scene.objects.back().ms.clear();
  }
  return scene;
}

SceneMemory remember_standing(SceneMemory memory, const std::string& sensor, const AssociateOptions& options) {
  ++memory.frames;
  ++memory.frames_since_look;
  for (Track& track : memory.tracks) {
    if (stands_there(track, sensor)) ++track.fit.unchanged_frames;
    if (track.sensor == sensor && track.missed_frames > 0) ++track.missed_frames;
  }
  std::erase_if(memory.tracks, [&](const Track& track) { return track.missed_frames > options.max_missed_frames; });
  return memory;
}

SceneMemory remember(const Scene& scene, const Frame& frame, const std::vector<ObjectView>& views, const SceneMemory& memory, const AssociateOptions& options) {
  SceneMemory next;
  next.next_id = memory.next_id;
  next.frames = memory.frames + 1;
  next.last_support = scene.support ? scene.support : memory.last_support;
  next.look = look_at(frame, scene);
  for (const ObjectView& view : views) {
    next.tracks.push_back(next_track(view, scene, find_track(memory, view.id)));
    next.next_id = std::max(next.next_id, view.id + 1);
  }
  for (const Track& track : memory.tracks) {
    if (seen(views, track.id)) continue;
    const int missed = track.missed_frames + (track.sensor == scene.sensor ? 1 : 0);  // another sensor's silence says nothing
    if (missed > options.max_missed_frames) continue;
    next.tracks.push_back(track);
    next.tracks.back().missed_frames = missed;
  }
  std::sort(next.tracks.begin(), next.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  return next;
}

}  // namespace gfp
