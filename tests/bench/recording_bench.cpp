// What recording costs: frames and scenes of a table with five objects at 30 Hz into files on the disk, all that the recorder thread does.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <vector>

#include "app/builtin_library.hpp"
#include "bench/bench_scenes.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "gfp/recording/recording_series.hpp"
#include "support/temporary_folder.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {
namespace {

struct Seen {
  Frame frame;
  Scene scene;
};

/// Frames of one standing scene, and what the pipeline made of them.
const std::vector<Seen>& frames() {
  static const std::vector<Seen> all = [] {
    std::vector<Seen> made;
    SceneMemory memory;
    for (const Frame& frame : bench::standing_frames()) {
      PipelineResult result = process_frame(frame, memory, builtin_library());
      memory = std::move(result.memory);
      made.push_back({frame, std::move(result.scene)});
    }
    return made;
  }();
  return all;
}

/// Argument: zstd level. `core_share` is the CPU time over the time of a frame at 30 Hz.
void BM_Record(benchmark::State& state) {
  const std::vector<Seen>& seen = frames();
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.mode = "continuous";
  options.folder = folder.path().string();
  options.min_free_mb = 0;
  options.zstd_level = static_cast<int>(state.range(0));
  const auto storage = disk_storage();
  RecordingSeries series(options, *storage);
  wire::RecordingMessages messages(options.content);
  Nanoseconds now{1};
  std::size_t next = 0;
  const auto sink = [&](const McapChannelSpec& spec, const McapMessage& message) { series.put(spec, message, now); };
  for (auto _ : state) {
    const Seen& one = seen[next++ % seen.size()];
    now += Nanoseconds(33'333'333);
    messages.put(one.frame, now, sink);
    messages.put(one.scene, now + Nanoseconds(1), sink);
    series.tick(now);
  }
  series.close();
  const double recorded_s = static_cast<double>(state.iterations()) / 30;
  state.counters["MB_per_s"] = 1e-6 * static_cast<double>(series.status().bytes) / recorded_s;
  state.counters["core_share"] = benchmark::Counter(static_cast<double>(state.iterations()) / 30, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["objects"] = static_cast<double>(seen.back().scene.objects.size());
}
BENCHMARK(BM_Record)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gfp
