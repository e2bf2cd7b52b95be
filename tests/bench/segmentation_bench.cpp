// Support plane and clusters: ours and PCL's three usual ways, with how well each covers the labelled objects.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench/bench_scenes.hpp"
#include "bench/peers_pcl.hpp"
#include "gfp/segmentation/segment_cloud.hpp"
#include "segmentation/components.hpp"
#include "segmentation/pixel_classes.hpp"
#include "segmentation/supports.hpp"

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

/// As if each scene had been seen before.
std::vector<SupportPlane> planes_of_last_frames(const benchmark::State& state) {
  std::vector<SupportPlane> planes;
  for (const auto& scene : scenes(state)) planes.push_back(segment_cloud(scene.cloud).planes.at(0));
  return planes;
}

/// As it runs: the plane of the frame before is known.
void BM_SegmentsOurs(benchmark::State& state) {
  const std::vector<SupportPlane> last = planes_of_last_frames(state);
  Turn turn(state);
  for (auto _ : state) {
    const SupportPlane& plane = last[turn.index()];
    benchmark::DoNotOptimize(segment_cloud(turn.next().cloud, {}, std::nullopt, &plane).segments.size());
  }
  std::size_t at = 0;
  state.counters["coverage"] = mean_coverage(state, [&](const BenchScene& scene) { return segment_cloud(scene.cloud, {}, std::nullopt, &last[at++]).labels; });
}

/// No more than what the peers do, on the same steps: planes, the pixels above them, and what is connected there.
Image<std::int32_t> plane_and_clusters(const OrganizedCloud& cloud, const SupportPlane& last) {
  const SegmentationOptions options;
  const Supports supports = find_supports(cloud, options, std::nullopt, &last);
  auto classes = classify_pixels(cloud, supports, options);
  std::vector<std::uint8_t> free(classes.size());
  std::transform(classes.begin(), classes.end(), free.begin(), [](std::uint8_t c) { return static_cast<std::uint8_t>(c >= kAbove); });
  Image<std::int32_t> labels(cloud.width, cloud.height, -1);
  std::int32_t label = 0;
  for (const PixelList& cluster :
       connected_components(depth_grid(cloud), free, classes, {options.cluster_tolerance_m, options.cluster_tolerance_m}, options.min_points)) {
    for (const std::int32_t i : cluster) labels.pixels[static_cast<std::size_t>(i)] = label;
    ++label;
  }
  return labels;
}

void BM_SegmentsOursPlaneAndClusters(benchmark::State& state) {
  const std::vector<SupportPlane> last = planes_of_last_frames(state);
  Turn turn(state);
  for (auto _ : state) {
    const SupportPlane& plane = last[turn.index()];
    benchmark::DoNotOptimize(plane_and_clusters(turn.next().cloud, plane).pixels.size());
  }
  std::size_t at = 0;
  state.counters["coverage"] = mean_coverage(state, [&](const BenchScene& scene) { return plane_and_clusters(scene.cloud, last[at++]); });
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
BENCHMARK(BM_SegmentsOursPlaneAndClusters) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsOursFirstFrame) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPclVoxels10mm) GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPcl<&PclPeer::organised_clusters>)->Name("BM_SegmentsPclOrganised") GFP_EACH_SOURCE;
BENCHMARK(BM_SegmentsPcl<&PclPeer::dense_clusters>)->Name("BM_SegmentsPclDense") GFP_EACH_SOURCE->Iterations(3);
#undef GFP_EACH_SOURCE

}  // namespace
}  // namespace gfp::bench
