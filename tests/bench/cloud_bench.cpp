// Depth image to organised cloud and to normals: ours, OpenCV, PCL and a plain copy of the output.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "bench/bench_scenes.hpp"
#include "bench/peers_opencv.hpp"
#include "bench/peers_pcl.hpp"
#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/cloud/estimate_normals.hpp"

namespace gfp::bench {
namespace {

void BM_CloudOurs(benchmark::State& state) {
  Turn turn(state);
  OrganizedCloud cloud;
  for (auto _ : state) {
    const auto& scene = turn.next().labelled;
    depth_to_cloud_into(scene.depth, scene.camera, {}, cloud);
    benchmark::DoNotOptimize(cloud.z.data());
    benchmark::ClobberMemory();
  }
}

void BM_CloudMemcpyOfOutput(benchmark::State& state) {
  Turn turn(state);
  const auto& scene = turn.next();
  std::vector<float> copy(3 * scene.cloud.size());
  for (auto _ : state) {
    const auto& cloud = turn.next().cloud;
    float* out = copy.data();
    for (const auto* plane : {&cloud.x, &cloud.y, &cloud.z}) {
      std::memcpy(out, plane->data(), plane->size() * sizeof(float));
      out += plane->size();
    }
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
}

void BM_CloudOpencv(benchmark::State& state) {
  Turn turn(state);
  OpencvPeer opencv(turn.next().labelled.camera);
  for (auto _ : state) opencv.depth_to_cloud(turn.next().labelled.depth);
}

void BM_CloudPcl(benchmark::State& state) {
  Turn turn(state);
  PclPeer pcl;
  for (auto _ : state) {
    const auto& scene = turn.next().labelled;
    pcl.depth_to_cloud(scene.depth, scene.camera);
    benchmark::ClobberMemory();
  }
}

/// Mean angle to the table's true normal, and the share of pixels with readings that have a normal.
class NormalScore {
 public:
  void add(const BenchScene& scene, const NormalMap& normals) {
    for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
      readings_ += scene.cloud.valid(i) ? 1 : 0;
      valid_ += scene.cloud.valid(i) && normals.valid(i) ? 1 : 0;
    }
    for (const std::size_t i : scene.table_pixels) {
      if (!normals.valid(i)) continue;
      const double cosine = std::abs(normals.normal(i).cast<double>().dot(scene.table_normal_camera));
      degrees_ += std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
      ++table_;
    }
  }
  void report(benchmark::State& state) const {
    state.counters["valid_%"] = 100.0 * valid_ / std::max(1, readings_);
    if (table_ > 0) state.counters["table_deg"] = degrees_ / table_;
  }

 private:
  int readings_ = 0, valid_ = 0, table_ = 0;
  double degrees_ = 0;
};

void BM_NormalsOurs(benchmark::State& state) {
  Turn turn(state);
  for (auto _ : state) benchmark::DoNotOptimize(estimate_normals(turn.next().cloud).z.data());
  NormalScore score;
  for (const auto& scene : scenes(state)) score.add(scene, estimate_normals(scene.cloud));
  score.report(state);
}

template <class Peer>
void measure_normals(benchmark::State& state, Peer& peer) {
  Turn turn(state);
  NormalScore score;
  for (const auto& scene : scenes(state)) {
    peer.set_cloud(scene.cloud);
    peer.normals();
    score.add(scene, peer.normal_map());
  }
  for (auto _ : state) {
    state.PauseTiming();
    peer.set_cloud(turn.next().cloud);
    state.ResumeTiming();
    peer.normals();
  }
  score.report(state);
}

void BM_NormalsOpencvLinemod(benchmark::State& state) {
  OpencvPeer opencv(scenes(state).front().labelled.camera);
  measure_normals(state, opencv);
}

void BM_NormalsPcl3dGradient(benchmark::State& state) {
  PclPeer pcl;
  measure_normals(state, pcl);
}

#define GFP_EACH_SOURCE ->Apply(each_source)->ArgName("real")->Unit(benchmark::kMillisecond)
BENCHMARK(BM_CloudOurs) GFP_EACH_SOURCE;
BENCHMARK(BM_CloudMemcpyOfOutput) GFP_EACH_SOURCE;
BENCHMARK(BM_CloudOpencv) GFP_EACH_SOURCE;
BENCHMARK(BM_CloudPcl) GFP_EACH_SOURCE;
BENCHMARK(BM_NormalsOurs) GFP_EACH_SOURCE;
BENCHMARK(BM_NormalsOpencvLinemod) GFP_EACH_SOURCE;
BENCHMARK(BM_NormalsPcl3dGradient) GFP_EACH_SOURCE;
#undef GFP_EACH_SOURCE

}  // namespace
}  // namespace gfp::bench
