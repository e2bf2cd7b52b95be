// Rigid alignment beside PCL's ICP, active contours beside the sphere's, superquadrics, and a whole fit of one hypothesis. One core.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <map>
#include <numbers>

#include "app/builtin_library.hpp"
#include "gfp/core/random.hpp"
#include "gfp/evaluation/surface_samples.hpp"
#include "gfp/modelling/evaluate_fit.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "gfp/modelling/recover_superquadric.hpp"
#include "gfp/primitive/upsampled.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "registration/align_icp.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp::bench {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

/// A primitive with about as many points as the argument says: the can has 422, the upsampled cup 2354.
PrimitivePtr primitive_with(std::int64_t points) {
  static const PrimitivePtr few = builtin_library().find("can");
  static const PrimitivePtr many = std::make_shared<const Primitive>(upsampled(*builtin_library().find("cup"), 1));
  return points < 1000 ? few : many;
}

/// A member of the primitive's class that is 12 % wider than the mean, as a Kinect sees it from 0.8 m, and the placement of the class on it.
struct Seen {
  ObjectView view;
  Placement placement;
};

const Seen& seen(std::int64_t points) {
  static std::map<std::int64_t, Seen> all;
  const auto [entry, fresh] = all.try_emplace(points);
  if (fresh) {
    const PrimitivePtr primitive = primitive_with(points);
    const Vector3d size = primitive->typical_size_m().cwiseProduct(Vector3d(1.12, 1.12, 1));
    const TriangleMesh mesh{shape(*primitive, size, {1.0, -0.5}), primitive->topology->triangles};
    entry->second.view = test::view_of(mesh, default_kinect_camera(), test::look_at({0, 0, 0.5 * size.z()}, 0.8, 35 * kDegree, 20 * kDegree), {.noise_scale = 1});
    entry->second.placement = register_primitive(entry->second.view, {primitive, 0.0, {}}).front();
  }
  return entry->second;
}

template <class Body>
void on_one_core(benchmark::State& state, Body&& body) {
  tbb::task_arena one(1);
  one.execute([&] {
    for (auto _ : state) body();
  });
}

/// Source points on the side of a surface that one looks at, moved by 8 degrees and 10 mm; the target is the primitive's points.
struct AlignmentProblem {
  std::vector<Vector3d> source, target;
};

const AlignmentProblem& alignment(std::int64_t points) {
  static std::map<std::int64_t, AlignmentProblem> all;
  const auto [entry, fresh] = all.try_emplace(points);
  if (fresh) {
    const PrimitivePtr primitive = primitive_with(points);
    const TriangleMesh mesh{shape(*primitive, primitive->typical_size_m()), primitive->topology->triangles};
    const std::size_t wanted = points < 1000 ? 3000 : 10'000;
    const SurfaceSamples samples = sample_surface(mesh, static_cast<int>(4 * wanted), 1);
    const Transform motion = Transform(Eigen::Translation3d(0.006, -0.007, 0.004) * Eigen::AngleAxisd(8 * kDegree, Vector3d(1, 2, 3).normalized()));
    Random random(1);
    const Vector3d eye(0.6, 0.2, 0.5), middle(0, 0, 0.5 * mesh.vertices.front().z());
    for (std::size_t k = 0; k < samples.points.size() && entry->second.source.size() < wanted; ++k)
      if ((samples.points[k] - middle).dot(eye) > 0)
        entry->second.source.push_back(motion * (samples.points[k] + 0.001 * Vector3d(random.normal(), random.normal(), random.normal())));
    entry->second.target = mesh.vertices;
  }
  return entry->second;
}

template <IcpResult (*align)(const std::vector<Vector3d>&, const std::vector<Vector3d>&, int)>
void BM_Align(benchmark::State& state) {
  const AlignmentProblem& problem = alignment(state.range(0));
  IcpResult result;
  on_one_core(state, [&] { benchmark::DoNotOptimize(result = align(problem.source, problem.target, 100)); });
  state.counters["rms_mm"] = 1e3 * std::sqrt(result.mean_squared_m2);
  state.counters["iterations"] = result.iterations;
  state.counters["source"] = static_cast<double>(problem.source.size());
  state.counters["target"] = static_cast<double>(problem.target.size());
}

void report(benchmark::State& state, const FittedModel& model) {
  state.counters["points"] = static_cast<double>(model.vertices.size());
  state.counters["iterations"] = model.iterations;
  state.counters["rms_mm"] = 1e3 * model.evidence.rms_m;
}

void BM_ContourRobust(benchmark::State& state) {
  const Seen& s = seen(state.range(0));
  FittedModel model;
  on_one_core(state, [&] { model = model_contour(s.view, s.placement); });
  report(state, model);
}

/// The part of BM_ContourRobust that judges the result and moves nothing: every method pays it.
void BM_EvaluateFit(benchmark::State& state) {
  const Seen& s = seen(state.range(0));
  const FittedModel model = model_contour(s.view, s.placement);
  const std::vector<Vector3d> vertices = model.vertices_camera();
  std::vector<std::uint8_t> states;
  on_one_core(state, [&] { benchmark::DoNotOptimize(evaluate_fit(s.view, vertices, model.topology->triangles, states)); });
  report(state, model);
}

/// 21 explicit steps, as in the paper's case study; a settled contour stops before.
template <ContourDirections directions, bool kd_tree>
void BM_ContourPaper(benchmark::State& state) {
  const Seen& s = seen(state.range(0));
  FittedModel model;
  on_one_core(state, [&] { model = model_contour_paper(s.view, s.placement, {.max_iterations = 21, .kd_tree = kd_tree}, directions); });
  report(state, model);
}

/// 610 points; the argument only picks the view.
template <ContourDirections directions, bool kd_tree>
void BM_ContourFromSphere(benchmark::State& state) {
  const Seen& s = seen(state.range(0));
  FittedModel model;
  on_one_core(state, [&] { model = fit_sphere_snake(s.view, {.kd_tree = kd_tree}, directions); });
  report(state, model);
}

/// Registration and contour of one class, nothing known before.
void BM_FitOneHypothesis(benchmark::State& state) {
  const Seen& s = seen(state.range(0));
  FittedModel model;
  on_one_core(state, [&] { model = model_contour(s.view, register_primitive(s.view, {primitive_with(state.range(0)), 0.0, {}}).front()); });
  report(state, model);
}

template <Result<SuperquadricFit> (*recover)(std::span<const Vector3d>, const RecoverSuperquadricOptions&)>
void BM_Superquadric(benchmark::State& state) {
  Superquadric body{{0.03, 0.04, 0.07}, 0.4, 0.8};
  Random random(1);
  std::vector<Vector3d> points;
  const TriangleMesh mesh{superquadric_vertices(body), superquadric_topology()->triangles};
  for (const Vector3d& p : sample_surface(mesh, 3000, 1).points)
    if (points.size() < 1000 && p.dot(Vector3d(1, 0.5, 0.8)) > 0) points.push_back(p + 0.001 * Vector3d(random.normal(), random.normal(), random.normal()));
  double rms = 0;
  on_one_core(state, [&] { rms = recover(points, {})->rms_m; });
  state.counters["points"] = static_cast<double>(points.size());
  state.counters["rms_mm"] = 1e3 * rms;
}

#define GFP_BOTH_SIZES ->ArgName("points")->Arg(410)->Arg(2500)->Unit(benchmark::kMillisecond)
BENCHMARK(BM_Align<&align_icp>)->Name("BM_AlignOurs") GFP_BOTH_SIZES;
BENCHMARK(BM_Align<&align_icp_pcl>)->Name("BM_AlignPclIcp") GFP_BOTH_SIZES;
BENCHMARK(BM_ContourRobust) GFP_BOTH_SIZES;
BENCHMARK(BM_EvaluateFit) GFP_BOTH_SIZES;
BENCHMARK(BM_ContourPaper<ContourDirections::kNormal, false>)->Name("BM_ContourPaper") GFP_BOTH_SIZES;
BENCHMARK(BM_ContourPaper<ContourDirections::kNormal, true>)->Name("BM_ContourPaperKdTree") GFP_BOTH_SIZES;
BENCHMARK(BM_ContourPaper<ContourDirections::kGrid26, true>)->Name("BM_ContourPaper26KdTree") GFP_BOTH_SIZES;
BENCHMARK(BM_ContourFromSphere<ContourDirections::kNormal, false>)->Name("BM_ContourFromSphere") GFP_BOTH_SIZES;
BENCHMARK(BM_ContourFromSphere<ContourDirections::kGrid26, true>)->Name("BM_ContourFromSphere26KdTree") GFP_BOTH_SIZES;
BENCHMARK(BM_FitOneHypothesis) GFP_BOTH_SIZES;
BENCHMARK(BM_Superquadric<&recover_superquadric_ems>)->Name("BM_SuperquadricEms")->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Superquadric<&recover_superquadric_lm>)->Name("BM_SuperquadricLm")->Unit(benchmark::kMillisecond);
#undef GFP_BOTH_SIZES

}  // namespace
}  // namespace gfp::bench
