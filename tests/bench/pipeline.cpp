// The whole frame: depth image to Scene with grasps, 640 x 480, five objects of the families on a table, Kinect noise.
#include <benchmark/benchmark.h>

#include <vector>

#include "app/builtin_library.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "gfp/simulation/table_top_scene.hpp"
#include "gfp/simulation/virtual_camera.hpp"

namespace gfp {
namespace {

constexpr double kFrameBudgetMs = 1000.0 / 30;

/// Frames of one standing scene, each with its own noise.
const std::vector<Frame>& frames() {
  static const std::vector<Frame> all = [] {
    TableTopOptions options;
    options.objects = 5;
    const VirtualScene scene = table_top_scene(options, 7);
    std::vector<Frame> made;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      made.push_back(capture(scene, default_kinect_camera(), look_at_pose({0, 0, 0.05}, 0.9, 0.7, -1.57), {}, seed).frame);
      made.back().sensor = "bench";
      made.back().sequence = seed;
    }
    return made;
  }();
  return all;
}

void report(benchmark::State& state, std::size_t objects) {
  state.counters["objects"] = static_cast<double>(objects);
  state.counters["frame_budgets"] = benchmark::Counter(static_cast<double>(state.iterations()) * kFrameBudgetMs * 1e-3, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Nothing is known: every class is searched for every object.
void BM_WholeFrameCold(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  std::size_t next = 0, objects = 0;
  for (auto _ : state) objects = process_frame(frames()[next++ % frames().size()], {}, library).scene.objects.size();
  report(state, objects);
}

/// Every object is fitted again, from what it was in the frame before.
void BM_WholeFrameWarm(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  PipelineOptions options;
  options.memory.unchanged_iou = 1.0;  // noise alone counts as a change
  options.memory.look_again_every = 1;
  SceneMemory memory = process_frame(frames()[0], {}, library, options).memory;
  std::size_t next = 1, objects = 0;
  for (auto _ : state) {
    PipelineResult result = process_frame(frames()[next++ % frames().size()], memory, library, options);
    objects = result.scene.objects.size();
    memory = std::move(result.memory);
  }
  report(state, objects);
}

/// The demo's table: nothing moves, noise is all that changes.
void BM_WholeFrameStatic(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  SceneMemory memory = process_frame(frames()[0], {}, library).memory;
  std::size_t next = 1, objects = 0;
  for (auto _ : state) {
    PipelineResult result = process_frame(frames()[next++ % frames().size()], memory, library);
    objects = result.scene.objects.size();
    memory = std::move(result.memory);
  }
  report(state, objects);
}

BENCHMARK(BM_WholeFrameCold)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_WholeFrameWarm)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_WholeFrameStatic)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gfp
