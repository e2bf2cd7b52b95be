// The whole frame: depth image to Scene with grasps, 640 x 480, five objects of the families on a table, Kinect noise.
#include <benchmark/benchmark.h>

#include "app/builtin_library.hpp"
#include "bench/bench_scenes.hpp"
#include "gfp/pipeline/process_frame.hpp"

namespace gfp {
namespace {

constexpr double kFrameBudgetMs = 1000.0 / 30;

void report(benchmark::State& state, std::size_t objects) {
  state.counters["objects"] = static_cast<double>(objects);
  state.counters["frame_budgets"] = benchmark::Counter(static_cast<double>(state.iterations()) * kFrameBudgetMs * 1e-3, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Nothing is known: every class is searched for every object.
void BM_WholeFrameCold(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  std::size_t next = 0, objects = 0;
  for (auto _ : state) objects = process_frame(bench::standing_frames()[next++ % bench::standing_frames().size()], {}, library).scene.objects.size();
  report(state, objects);
}

/// Every object changed: it is followed from the frame before, and shaped anew when it is its turn.
void BM_WholeFrameWarm(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  PipelineOptions options;
  options.memory.unchanged_iou = 1.0;  // noise alone counts as a change
  options.memory.look_again_every = 1;
  SceneMemory memory = process_frame(bench::standing_frames()[0], {}, library, options).memory;
  std::size_t next = 1, objects = 0;
  for (auto _ : state) {
    PipelineResult result = process_frame(bench::standing_frames()[next++ % bench::standing_frames().size()], memory, library, options);
    objects = result.scene.objects.size();
    memory = std::move(result.memory);
  }
  report(state, objects);
}

/// The demo's table: nothing moves, noise is all that changes.
void BM_WholeFrameStatic(benchmark::State& state) {
  const PrimitiveLibrary& library = builtin_library();
  SceneMemory memory = process_frame(bench::standing_frames()[0], {}, library).memory;
  std::size_t next = 1, objects = 0;
  for (auto _ : state) {
    PipelineResult result = process_frame(bench::standing_frames()[next++ % bench::standing_frames().size()], memory, library);
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
