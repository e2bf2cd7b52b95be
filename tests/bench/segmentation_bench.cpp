// Support plane and clusters: ours and PCL's three usual ways, with how well each covers the labelled objects.
#include <benchmark/benchmark.h>

#include "bench/bench_scenes.hpp"
#include "bench/peers_pcl.hpp"
#include "gfp/segmentation/segment_cloud.hpp"

namespace gfp::bench {
namespace {

/// Mean best IoU over the labelled objects of all scenes.
template <class Segmenter>
double mean_coverage(const benchmark::State& state, Segmenter&& segmenter) {
  double sum = 0;
  int objects = 0;
  for (const auto& scene : scenes(state)) {
    const auto covered = test::coverage(scene.labelled, segmenter(scene));
    sum += covered.sum;
    objects += covered.objects;
  }
  return objects == 0 ? 0 : sum / objects;
}

void BM_SegmentsOursFirstFrame(benchmark::State& state) {
  Turn turn(state);
  for (auto _ : state) benchmark::DoNotOptimize(segment_cloud(turn.next().cloud).segments.size());
  state.counters["coverage"] = mean_coverage(state, [](const BenchScene& scene) { return segment_cloud(scene.cloud).labels; });
}

/// As it runs: the plane of the frame before is known.
void BM_SegmentsOurs(benchmark::State& state) {
  std::vector<SupportPlane> last;
  for (const auto& scene : scenes(state)) last.push_back(segment_cloud(scene.cloud).planes.at(0));
  Turn turn(state);
  for (auto _ : state) {
    const SupportPlane& plane = last[turn.index()];
    benchmark::DoNotOptimize(segment_cloud(turn.next().cloud, {}, std::nullopt, &plane).segments.size());
  }
  std::size_t at = 0;
  state.counters["coverage"] = mean_coverage(state, [&](const BenchScene& scene) { return segment_cloud(scene.cloud, {}, std::nullopt, &last[at++]).labels; });
}

template <class Run>
void measure_pcl(benchmark::State& state, Run&& run) {
  Turn turn(state);
  PclPeer pcl;
  for (auto _ : state) {
    state.PauseTiming();
    pcl.set_cloud(turn.next().cloud);
    state.ResumeTiming();
    benchmark::DoNotOptimize(run(pcl));
  }
}

void BM_SegmentsPclVoxels10mm(benchmark::State& state) {
  measure_pcl(state, [](PclPeer& pcl) { return pcl.voxel_clusters(); });
}

template <Image<std::int32_t> (PclPeer::*method)()>
void BM_SegmentsPcl(benchmark::State& state) {
  measure_pcl(state, [](PclPeer& pcl) { return (pcl.*method)().pixels.size(); });
  PclPeer pcl;
  state.counters["coverage"] = mean_coverage(state, [&](const BenchScene& scene) {
    pcl.set_cloud(scene.cloud);
    return (pcl.*method)();
  });
}

#define GFP_EACH_SOURCE ->Apply(each_source)->ArgName("real")->Unit(benchmark::kMillisecond)
BENCHMARK(BM_SegmentsOurs) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsOursFirstFrame) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPclVoxels10mm) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPcl<&PclPeer::organised_clusters>)->Name("BM_SegmentsPclOrganised") GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPcl<&PclPeer::dense_clusters>)->Name("BM_SegmentsPclDense") GFP_EACH_SOURCE->Iterations(3);
#undef GFP_EACH_SOURCE

}  // namespace
}  // namespace gfp::bench
