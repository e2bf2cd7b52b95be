// Grasp quality beside qhull (the same contacts, epsilon only), and whole grasp plans.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "gfp/core/random.hpp"
#include "gfp/grasp/plan_grasps.hpp"
#include "gfp/grasp/wrench_space.hpp"
#include "grasp/qhull_oracle.hpp"
#include "grasp/shapes.hpp"

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

/// A fit of about 1200 triangles on the table, its far half hidden, 3 mm of uncertainty there.
FittedModel half_seen(const TriangleMesh& mesh) {
  FittedModel model = test::fit_of(mesh, 0.001);
  for (std::size_t v = 0; v < model.vertices.size(); ++v)
    if (model.vertices[v].y() > 0) {
      model.states[v] = 0;
      model.sigma_m[v] = 0.003F;
    }
  return model;
}

/// The whole plan for one object. `poses/s`: jaw poses on antipodal contacts that were examined, all work included.
void BM_PlanGrasps(benchmark::State& state) {
  const std::vector<TriangleMesh> shapes{test::box_mesh({0.06, 0.09, 0.12}, 10), test::cylinder_mesh(0.033, 0.12, 40, 13),
                                         test::cup_mesh(0.042, 0.09, 0.003, 32), test::ring_mesh(0.04, 0.006, 50, 12)};
  const FittedModel model = half_seen(shapes.at(static_cast<std::size_t>(state.range(0))));
  const FittedModel neighbour = [&] {
    FittedModel other = half_seen(shapes[1]);
    other.T_camera_object = other.T_camera_object * Eigen::Translation3d(0.15, 0, 0);
    return other;
  }();
  GraspScene scene = test::table_scene();
  scene.neighbours = {&neighbour};
  GraspPlan plan;
  for (auto _ : state) plan = plan_grasps(model, scene);
  state.counters["poses/s"] = benchmark::Counter(plan.poses_examined, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["triangles"] = static_cast<double>(model.topology->triangles.size());
  state.counters["grasps"] = static_cast<double>(plan.grasps.size());
}
BENCHMARK(BM_PlanGrasps)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

// Contacts, torsion in millimetres (0 is a hard finger).
#define GFP_GRASP_CASES ->Args({2, 5})->Args({3, 0})->Args({4, 0})->Args({4, 5})->Unit(benchmark::kMicrosecond)
BENCHMARK(BM_EpsilonQhull) GFP_GRASP_CASES;
BENCHMARK(BM_EpsilonExact) GFP_GRASP_CASES;
BENCHMARK(BM_EpsilonLowerBound) GFP_GRASP_CASES;
#undef GFP_GRASP_CASES

}  // namespace
}  // namespace gfp
