#include "gfp/pipeline/process_frame.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "gfp/pipeline/fit_view.hpp"
#include "gfp/scene/remember.hpp"
#include "gfp/segmentation/segment_cloud_paper.hpp"
#include "pipeline/plan_scene_grasps.hpp"

namespace gfp {
namespace {

Segments segment(const OrganizedCloud& cloud, const Frame& frame, const SceneMemory& memory, const PipelineOptions& options) {
  if (options.profile == "paper") return segment_cloud_paper(cloud, options.segmentation, frame.up_camera, frame.mask);
  const auto& last = memory.of(frame.sensor).last_support;
  return segment_cloud(cloud, options.segmentation, frame.up_camera, last ? &*last : nullptr, frame.mask);
}

std::vector<PixelRect> object_boxes(const Segments& segments) {
  std::vector<PixelRect> boxes;
  for (const Segment& segment : segments.segments) boxes.push_back(segment.bbox);
  return boxes;
}

NormalMap object_normals(const OrganizedCloud& cloud, const Segments& segments, const EstimateNormalsOptions& options) {
  if (segments.segments.empty()) return {};  // an empty region would mean the whole image
  return estimate_normals(cloud, options, object_boxes(segments));
}

/// One object on its way through the stages; `candidates` stay empty where nothing could be fitted.
struct Work {
  const ObjectView* view = nullptr;
  const SceneObject* before = nullptr;  ///< As last published for this sensor; by another one where this one has not seen it yet.
  const ObjectView* view_before = nullptr;
  std::vector<Candidate> candidates;
  StageTimings timings;
  SceneObject object;

  bool unchanged() const { return view->unchanged && before; }
};

std::vector<Work> plan_work(const std::vector<ObjectView>& views, const SceneMemory& memory, const std::string& sensor) {
  std::vector<Work> work(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    work[i].view = &views[i];
    const Track* track = memory.track(views[i].id);
    if (!track) continue;
    const SensorTrack* own = track->seen_by(sensor);
    const SensorTrack& seen = own && own->object ? *own : track->last();
    work[i].before = seen.object.get();
    work[i].view_before = seen.fitted_view.get();
  }
  return work;
}

void fit(Work& work, const PrimitiveLibrary& library, const PipelineOptions& options) {
  if (work.unchanged()) {
    work.candidates = {{work.before->model, 0.0}};
  } else if (auto candidates = fit_view(*work.view, library, options, &work.timings)) {
    work.candidates = std::move(*candidates);
  }
}

/// Takes what has no fit out of the work, and says why.
std::vector<RejectedSegment> reject_unfitted(std::vector<Work>& work) {
  std::vector<RejectedSegment> rejected;
  for (const Work& w : work)
    if (w.candidates.empty()) rejected.push_back({w.view->object_pixels, "no_fit"});
  std::erase_if(work, [](const Work& w) { return w.candidates.empty(); });
  return rejected;
}

std::vector<ObjectEstimate> select(std::vector<Work>& work, const std::vector<ObjectView>& views, const SelectionOptions& options) {
  std::vector<std::vector<Candidate>> candidates;
  for (Work& w : work) candidates.push_back(std::move(w.candidates));
  if (work.size() == views.size()) return select_models(views, std::move(candidates), options);
  std::vector<ObjectView> fitted;  // rare: views are large
  for (const Work& w : work) fitted.push_back(*w.view);
  return select_models(fitted, std::move(candidates), options);
}

void finish(Work& work, ObjectEstimate estimate, const PipelineOptions& options) {
  if (work.unchanged()) {
    work.object = *work.before;
    work.object.status = ObjectStatus::kUnchanged;
    work.object.ms.clear();
    return;
  }
  // A tracked fit looked at one class only, so what is known of the others is what was known before.
  const bool followed = is_tracked(*work.view, options.budget) && work.before && work.before->model.class_name == estimate.model.class_name;
  if (followed) estimate.class_probabilities = work.before->class_probabilities;
  const ObjectStatus status = work.before ? ObjectStatus::kUpdated : ObjectStatus::kAdded;
  work.object = work.timings.measure("describe", [&] { return describe(std::move(estimate), *work.view, status); });
  work.object.ms = work.timings.ms();
}

/// Every segment as far as it gets: fitted in parallel, chosen jointly, described in parallel.
std::vector<Work> estimate_objects(const std::vector<ObjectView>& views, const SceneMemory& memory, const std::string& sensor, const PrimitiveLibrary& library,
                                   const PipelineOptions& options, std::vector<RejectedSegment>& rejected, StageTimings& timings) {
  std::vector<Work> work = plan_work(views, memory, sensor);
  timings.measure("fit", [&] { oneapi::tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t i) { fit(work[i], library, options); }); });
  const std::vector<RejectedSegment> unfitted = reject_unfitted(work);
  rejected.insert(rejected.end(), unfitted.begin(), unfitted.end());
  auto estimates = timings.measure("selection", [&] { return select(work, views, options.selection); });
  timings.measure("describe", [&] {
    oneapi::tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t i) { finish(work[i], std::move(estimates[i]), options); });
  });
  std::sort(work.begin(), work.end(), [](const Work& a, const Work& b) { return a.view->id < b.view->id; });
  return work;
}

/// What every scene says of its frame, whatever was seen on it.
Scene stamped(Scene scene, const Frame& frame, const PipelineOptions& options) {
  scene.sensor = frame.sensor;
  scene.sequence = frame.sequence;
  scene.stamps = frame.stamps;
  scene.camera = frame.camera;
  scene.T_world_sensor = frame.T_world_sensor;
  scene.profile = options.profile;
  return scene;
}

Scene empty_scene(const Segments& segments) {
  Scene scene;
  if (!segments.planes.empty()) scene.support = segments.planes.front();
  scene.rejected = segments.rejected;
  return scene;
}

void add_objects(Scene& scene, std::vector<Work> work, const Segments& segments, const OrganizedCloud& cloud, const SceneMemory& memory,
                 const PipelineOptions& options) {
  std::vector<const SceneObject*> left;
  for (const std::uint64_t id : scene.lost)
    if (const Track* track = memory.track(id)) left.push_back(track->seen_by(scene.sensor)->object.get());
  std::vector<GraspSubject> subjects;
  for (Work& w : work) subjects.push_back({&w.object, w.view, w.before, w.view_before});
  plan_scene_grasps(subjects, segments, cloud, left, options);
  for (Work& w : work) scene.objects.push_back(std::move(w.object));
}

/// A fit of a primitive that the library no longer has, or has otherwise (a person said what its points are): it holds no more.
bool is_outdated(const Track& track, const std::string& sensor, const PrimitiveLibrary& library) {
  const SensorTrack* own = track.seen_by(sensor);
  for (const SceneObject* object : {track.last().object.get(), own ? own->object.get() : nullptr}) {
    if (!object || !object->model.primitive) continue;
    const PrimitivePtr now = library.find(object->model.primitive->name);
    if (!now || now->content_hash != object->model.primitive->content_hash) return true;
  }
  return false;
}

/// What was fitted to them before says nothing of the objects with outdated fits: they are fitted as if they were new.
void forget_outdated(std::vector<ObjectView>& views, const SceneMemory& memory, const std::string& sensor, const PrimitiveLibrary& library) {
  for (ObjectView& view : views) {
    const Track* track = memory.track(view.id);
    if (!track || !is_outdated(*track, sensor, library)) continue;
    view.warm_start.reset();
    view.unchanged = false;
  }
}

/// A frame that shows the same as the last one looked at is the same scene; now and then one is looked at all the same.
bool stands_still(const Frame& frame, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options) {
  for (const Track& track : memory.tracks)
    if (track.seen_by(frame.sensor) && is_outdated(track, frame.sensor, library)) return false;
  const SensorMemory& sensor = memory.of(frame.sensor);
  return sensor.look && sensor.look->field_changes == memory.field_changes && sensor.frames_since_look + 1 < options.memory.look_again_every &&
         shows_the_same(frame, sensor.look->frame);
}

PipelineResult look(const Frame& frame, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  const auto cloud = timings.measure("cloud", [&] { return depth_to_cloud(frame.depth, frame.camera, options.cloud); });
  const auto segments = timings.measure("segmentation", [&] { return segment(cloud, frame, memory, options); });
  const auto normals = timings.measure("normals", [&] { return object_normals(cloud, segments, options.normals); });
  auto views = timings.measure("association", [&] { return associate(segments, cloud, normals, frame, memory, options.memory); });
  forget_outdated(views, memory, frame.sensor, library);

  Scene scene = stamped(empty_scene(segments), frame, options);
  scene.lost = lost_ids(memory, views, frame.sensor);
  auto work = estimate_objects(views, memory, frame.sensor, library, options, scene.rejected, timings);
  timings.measure("grasps", [&] { add_objects(scene, std::move(work), segments, cloud, memory, options); });
  auto next = timings.measure("memory", [&] { return remember(scene, frame, views, memory, options.memory); });
  return {std::move(scene), std::move(next)};
}

}  // namespace

PipelineResult process_frame(const Frame& frame, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options) {
  StageTimings timings;
  const bool still = timings.measure("comparison", [&] { return stands_still(frame, memory, library, options); });
  PipelineResult result = still ? PipelineResult{stamped(standing_scene(memory, frame.sensor), frame, options),
                                                 remember_standing(memory, frame.sensor, options.memory)}
                                : look(frame, memory, library, options, timings);
  result.scene.ms = timings.ms();
  return result;
}

}  // namespace gfp
