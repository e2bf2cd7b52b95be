// How many points are within a radius: our voxel grid, nanoflann and PCL's kd-tree, on 10 000 points of a depth image.
#include <benchmark/benchmark.h>

#include <nanoflann.hpp>

#include "bench/bench_scenes.hpp"
#include "bench/peers_pcl.hpp"
#include "gfp/core/random.hpp"
#include "gfp/core/voxel_grid.hpp"

namespace gfp::bench {
namespace {

constexpr std::size_t kPoints = 10'000;

/// The readings around the middle of the first frame, row by row.
std::vector<Eigen::Vector3f> patch(Source source) {
  const OrganizedCloud& cloud = scenes(source).front().cloud;
  std::vector<Eigen::Vector3f> points;
  for (int v = cloud.height / 2 - 52; v < cloud.height; ++v)
    for (int u = cloud.width / 2 - 52; u < cloud.width / 2 + 52; ++u) {
      const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width) + static_cast<std::size_t>(u);
      if (cloud.valid(i) && points.size() < kPoints) points.push_back(cloud.point(i));
    }
  return points;
}

/// Arguments: source, radius in millimetres. Queries are the points themselves in a shuffled order.
struct Setup {
  std::vector<Eigen::Vector3f> points, queries;
  float radius_m;
  std::size_t at = 0;

  explicit Setup(const benchmark::State& state)
      : points(patch(static_cast<Source>(state.range(0)))), radius_m(1e-3F * static_cast<float>(state.range(1))) {
    Random random(1);
    for (std::size_t i = 0; i < points.size(); ++i) queries.push_back(points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))]);
  }
  const Eigen::Vector3f& next() {
    at = at + 1 < queries.size() ? at + 1 : 0;
    return queries[at];
  }
};

void report(benchmark::State& state, double found) { state.counters["inside"] = found / static_cast<double>(std::max<std::int64_t>(1, state.iterations())); }

void BM_RadiusCountOurs(benchmark::State& state) {
  Setup setup(state);
  const VoxelGrid grid(setup.points, 2 * setup.radius_m);
  double found = 0;
  for (auto _ : state) found += grid.count_within(setup.next(), setup.radius_m);
  report(state, found);
}

struct FlannPoints {
  const std::vector<Eigen::Vector3f>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const { return false; }
};
using FlannTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FlannPoints>, FlannPoints, 3, std::uint32_t>;

void BM_RadiusFindNanoflann(benchmark::State& state) {
  Setup setup(state);
  const FlannPoints adaptor{setup.points};
  const FlannTree tree(3, adaptor);
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  std::vector<std::pair<std::uint32_t, float>> matches;
  double found = 0;
  for (auto _ : state) found += static_cast<double>(tree.radiusSearch(setup.next().data(), setup.radius_m * setup.radius_m, matches, unsorted));
  report(state, found);
}

/// nanoflann made to count only, which its users have to write themselves.
struct CountWithin {
  using DistanceType = float;
  using IndexType = std::uint32_t;
  float radius2;
  std::size_t inside = 0;
  std::size_t size() const { return inside; }
  bool full() const { return true; }
  bool addPoint(float, std::uint32_t) { return ++inside, true; }
  float worstDist() const { return radius2; }
};

void BM_RadiusCountNanoflann(benchmark::State& state) {
  Setup setup(state);
  const FlannPoints adaptor{setup.points};
  const FlannTree tree(3, adaptor);
  double found = 0;
  for (auto _ : state) {
    CountWithin count{setup.radius_m * setup.radius_m};
    tree.findNeighbors(count, setup.next().data(), {});
    found += static_cast<double>(count.inside);
  }
  report(state, found);
}

void BM_RadiusFindPcl(benchmark::State& state) {
  Setup setup(state);
  PclTree tree(setup.points);
  double found = 0;
  for (auto _ : state) found += tree.within(setup.next(), setup.radius_m);
  report(state, found);
}

void BM_RadiusBuildOurs(benchmark::State& state) {
  Setup setup(state);
  for (auto _ : state) benchmark::DoNotOptimize(VoxelGrid(setup.points, 2 * setup.radius_m).size());
}

void BM_RadiusBuildNanoflann(benchmark::State& state) {
  Setup setup(state);
  const FlannPoints adaptor{setup.points};
  for (auto _ : state) {
    FlannTree tree(3, adaptor);
    auto bytes = tree.usedMemory(tree);
    benchmark::DoNotOptimize(bytes);
  }
}

void each_radius(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"real", "mm"})->ArgsProduct({{kSynthetic}, {3, 10}});
  if (has_real_frames()) benchmark->ArgsProduct({{kReal}, {3, 10}});
}

BENCHMARK(BM_RadiusCountOurs)->Apply(each_radius);
BENCHMARK(BM_RadiusCountNanoflann)->Apply(each_radius);
BENCHMARK(BM_RadiusFindNanoflann)->Apply(each_radius);
BENCHMARK(BM_RadiusFindPcl)->Apply(each_radius);
BENCHMARK(BM_RadiusBuildOurs)->Apply(each_radius);
BENCHMARK(BM_RadiusBuildNanoflann)->Apply(each_radius);

}  // namespace
}  // namespace gfp::bench
