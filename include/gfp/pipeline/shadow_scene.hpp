#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "gfp/memory/scene_memory.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// What a shadow found last, by id: an object that is still fitted to the same view is not fitted again.
struct ShadowMemory {
  struct Found {
    std::shared_ptr<const ObjectView> view;
    SceneObject object;
  };
  std::string method;
  std::map<std::uint64_t, Found> objects;
};

/// A scene's objects as another method sees them (P31): options.shadow, on the very views that they were fitted to, told their class. Ids, stamps
/// and statuses are the scene's, `profile` is the method's name; no grasps. Objects that the method cannot fit are left out.
/// @param memory  after the scene's frame. @param kept  of the last call; updated.
Scene shadow_scene(const Scene& scene, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options, ShadowMemory& kept);

}  // namespace gfp
