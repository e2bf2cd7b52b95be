// Grasp quality beside qhull: the same contacts, epsilon only.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "gfp/core/random.hpp"
#include "gfp/grasp/wrench_space.hpp"
#include "grasp/qhull_oracle.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

const WrenchScale kScale{Vector3d::Zero(), 0.06};

/// Sixteen force-closed grasps around an object of 5 cm, each slightly irregular as on a fitted mesh.
std::vector<std::vector<WrenchContact>> irregular_grasps(int contacts, double torsion_m) {
  std::vector<std::vector<WrenchContact>> grasps;
  for (Random random(7); grasps.size() < 16;) {
    std::vector<WrenchContact> grasp;
    for (int i = 0; i < contacts; ++i) {
      const double angle = 2 * std::numbers::pi * i / contacts;
      const Vector3d wobble(random.normal(), random.normal(), random.normal());
      const Vector3d outward = (Vector3d(std::cos(angle), std::sin(angle), 0) + 0.1 * wobble).normalized();
      grasp.push_back({0.05 * outward, -(outward + 0.05 * wobble).normalized(), 0.5, torsion_m});
    }
    if (grasp_quality(grasp, kScale).force_closure) grasps.push_back(grasp);
  }
  return grasps;
}

double torsion_of(const benchmark::State& state) { return 1e-3 * static_cast<double>(state.range(1)); }

void BM_EpsilonExact(benchmark::State& state) {
  const auto grasps = irregular_grasps(static_cast<int>(state.range(0)), torsion_of(state));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(grasp_quality(grasps[i++ % grasps.size()], kScale));
}

void BM_EpsilonLowerBound(benchmark::State& state) {
  const auto grasps = irregular_grasps(static_cast<int>(state.range(0)), torsion_of(state));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(epsilon_lower_bound(grasps[i++ % grasps.size()], kScale));
}

void BM_EpsilonQhull(benchmark::State& state) {
  const auto grasps = irregular_grasps(static_cast<int>(state.range(0)), torsion_of(state));
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(test::qhull_oracle(primitive_wrenches(grasps[i++ % grasps.size()], kScale), /*volume=*/false));
}

// Contacts, torsion in millimetres (0 is a hard finger).
#define GFP_GRASP_CASES ->Args({2, 5})->Args({3, 0})->Args({4, 0})->Args({4, 5})->Unit(benchmark::kMicrosecond)
BENCHMARK(BM_EpsilonQhull) GFP_GRASP_CASES;
BENCHMARK(BM_EpsilonExact) GFP_GRASP_CASES;
BENCHMARK(BM_EpsilonLowerBound) GFP_GRASP_CASES;
#undef GFP_GRASP_CASES

}  // namespace
}  // namespace gfp
