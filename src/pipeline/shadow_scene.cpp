#include "gfp/pipeline/shadow_scene.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "gfp/pipeline/fit_view.hpp"
#include "gfp/scene/remember.hpp"

namespace gfp {
namespace {

std::optional<SceneObject> fit_again(const SceneObject& object, const ObjectView& seen, const PrimitiveLibrary& library, PipelineOptions options) {
  options.method = options.shadow;
  if (const PrimitivePtr primitive = library.find(object.model.class_name)) options.recognition.only_class = primitive->class_name;
  ObjectView view = seen;
  view.warm_start.reset();
  view.unchanged = false;
  StageTimings timings;
  auto estimate = fit_object(view, library, options, &timings);
  if (!estimate || !*estimate) return std::nullopt;
  SceneObject shadow = describe(std::move(**estimate), view, object.status);
  shadow.ms = timings.ms();
  return shadow;
}

}  // namespace

Scene shadow_scene(const Scene& scene, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options, ShadowMemory& kept) {
  ShadowMemory last = std::exchange(kept, {options.shadow, {}});
  if (last.method != options.shadow) last = {};
  Scene result = scene;
  result.profile = options.shadow;
  result.objects.clear();
  result.ms.clear();
  for (const SceneObject& object : scene.objects) {
    const Track* track = memory.track(object.id);
    const SensorTrack* seen = track ? track->seen_by(scene.sensor) : nullptr;
    if (!seen || !seen->fitted_view) continue;
    const auto known = last.objects.find(object.id);
    std::optional<SceneObject> shadow;
    if (known != last.objects.end() && known->second.view == seen->fitted_view) {
      shadow = std::move(known->second.object);
      shadow->status = object.status;
    } else {
      shadow = fit_again(object, *seen->fitted_view, library, options);
    }
    if (!shadow) continue;
    kept.objects[object.id] = {seen->fitted_view, *shadow};
    result.objects.push_back(std::move(*shadow));
  }
  return result;
}

}  // namespace gfp
