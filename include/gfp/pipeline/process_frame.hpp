#pragma once

#include "gfp/frame/frame.hpp"
#include "gfp/memory/scene_memory.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// A frame's result and what the next frame needs of it.
struct PipelineResult {
  Scene scene;
  SceneMemory memory;
};

/// The whole pipeline, capture to Scene: pure; the same inputs give the same bytes at any thread count. Parallel over objects
/// in the calling oneTBB arena. A bad segment costs that segment (Scene::rejected), never the frame.
PipelineResult process_frame(const Frame& frame, const SceneMemory& memory, const PrimitiveLibrary& library, const PipelineOptions& options = {});

}  // namespace gfp
