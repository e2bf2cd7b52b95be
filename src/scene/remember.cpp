#include "gfp/scene/remember.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace gfp {
namespace {

const SceneObject* find_object(const Scene& scene, std::uint64_t id) {
  for (const SceneObject& object : scene.objects)
    if (object.id == id) return &object;
  return nullptr;
}

bool seen(const std::vector<ObjectView>& views, std::uint64_t id) {
  return std::any_of(views.begin(), views.end(), [&](const ObjectView& view) { return view.id == id; });
}

/// Pixels of what was seen.
SensorTrack seen_now(const ObjectView& view, const Scene& scene) {
  SensorTrack seen;
  seen.sensor = scene.sensor;
  seen.T_world_sensor = scene.T_world_sensor;
  seen.bbox = {view.tile.u1, view.tile.v1, view.tile.u0, view.tile.v0};
  seen.pixels.reserve(static_cast<std::size_t>(view.object_pixels));
  for (int v = view.tile.v0; v < view.tile.v1; ++v) {
    for (int u = view.tile.u0; u < view.tile.u1; ++u) {
      if (view.evidence.at(u - view.tile.u0, v - view.tile.v0) != Evidence::kObject) continue;
      seen.pixels.push_back(v * view.camera.width + u);
      seen.bbox = {std::min(seen.bbox.u0, u), std::min(seen.bbox.v0, v), std::max(seen.bbox.u1, u + 1), std::max(seen.bbox.v1, v + 1)};
    }
  }
  return seen;
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

bool same_views(const ObjectField& a, const ObjectField& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FieldView& x, const FieldView& y) { return x.view == y.view; });
}

Track next_track(const ObjectView& view, const Scene& scene, const Track* before, const AssociateOptions& options) {
  Track track = before ? *before : Track{};
  track.id = view.id;
  track.centre_world = scene.T_world_sensor * seen_centre(view);
  track.height_m = view.height_m;
  track.field = remember_view(std::move(track.field), scene.sensor, scene.T_world_sensor, view, options);
  SensorTrack now = seen_now(view, scene);
  const SensorTrack* last = before ? before->seen_by(scene.sensor) : nullptr;
  const SceneObject* object = find_object(scene, view.id);
  if (!object) {  // seen, but nothing could be fitted to it
    track.fit = {};
  } else {
    track.fit = warm_start_of(*object, track.fit);
    track.T_world_fit = scene.T_world_sensor;
    const bool still = object->status == ObjectStatus::kUnchanged && last && last->fitted_view;
    now.fitted_view = still ? last->fitted_view : std::make_shared<const ObjectView>(view);
    now.object = std::make_shared<const SceneObject>(*object);
    track.fit.model = std::shared_ptr<const FittedModel>(now.object, &now.object->model);
  }
  std::erase_if(track.sensors, [&](const SensorTrack& seen) { return seen.sensor == scene.sensor; });
  track.sensors.insert(track.sensors.begin(), std::move(now));
  return track;
}

/// Nothing where the frame is none: a depth image that does not fit its camera has no second look.
std::shared_ptr<const Look> look_at(const Frame& frame, const Scene& scene, std::uint64_t field_changes) {
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
  look->field_changes = field_changes;
  return look;
}

/// What `sensor` saw of it in its last frame; nothing where it did not.
const SceneObject* standing(const Track& track, const std::string& sensor) {
  const SensorTrack* seen = track.seen_by(sensor);
  return seen && seen->missed_frames == 0 ? seen->object.get() : nullptr;
}

/// One more frame of `sensor` without the object; nothing is left of what it has not seen for too long.
void miss(Track& track, const std::string& sensor, const AssociateOptions& options) {
  for (SensorTrack& seen : track.sensors) seen.missed_frames += seen.sensor == sensor ? 1 : 0;  // another sensor's silence says nothing
  std::erase_if(track.sensors, [&](const SensorTrack& seen) { return seen.missed_frames > options.max_missed_frames; });
}

}  // namespace

std::vector<std::uint64_t> lost_ids(const SceneMemory& memory, const std::vector<ObjectView>& views, const std::string& sensor) {
  std::vector<std::uint64_t> lost;
  for (const Track& track : memory.tracks)
    if (standing(track, sensor) && !seen(views, track.id)) lost.push_back(track.id);
  return lost;
}

Scene standing_scene(const SceneMemory& memory, const std::string& sensor) {
  const Look& look = *memory.of(sensor).look;
  Scene scene;
  scene.support = look.support;
  scene.rejected = look.rejected;
  for (const Track& track : memory.tracks) {
    const SceneObject* object = standing(track, sensor);
    if (!object) continue;
    scene.objects.push_back(*object);
    scene.objects.back().status = ObjectStatus::kUnchanged;
    scene.objects.back().ms.clear();
  }
  return scene;
}

SceneMemory remember_standing(SceneMemory memory, const std::string& sensor, const AssociateOptions& options) {
  ++memory.frames;
  ++memory.sensors[sensor].frames_since_look;
  for (Track& track : memory.tracks) {
    if (standing(track, sensor)) {
      ++track.fit.unchanged_frames;
    } else if (const SensorTrack* seen = track.seen_by(sensor); seen && seen->missed_frames > 0) {
      miss(track, sensor, options);
    }
  }
  std::erase_if(memory.tracks, [](const Track& track) { return track.sensors.empty(); });
  return memory;
}

SceneMemory remember(const Scene& scene, const Frame& frame, const std::vector<ObjectView>& views, const SceneMemory& memory, const AssociateOptions& options) {
  SceneMemory next;
  next.next_id = memory.next_id;
  next.frames = memory.frames + 1;
  next.field_changes = memory.field_changes;
  for (const ObjectView& view : views) {
    const Track* before = memory.track(view.id);
    next.tracks.push_back(next_track(view, scene, before, options));
    next.field_changes += same_views(next.tracks.back().field, before ? before->field : ObjectField{}) ? 0 : 1;
    next.next_id = std::max(next.next_id, view.id + 1);
  }
  for (const Track& track : memory.tracks) {
    if (seen(views, track.id)) continue;
    Track missed = track;
    miss(missed, scene.sensor, options);
    if (!missed.sensors.empty()) next.tracks.push_back(std::move(missed));
  }
  std::sort(next.tracks.begin(), next.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  next.sensors = memory.sensors;
  next.sensors[scene.sensor] = {scene.support ? scene.support : memory.of(scene.sensor).last_support, look_at(frame, scene, next.field_changes), 0};
  return next;
}

}  // namespace gfp
