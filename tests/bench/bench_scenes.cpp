#include "bench/bench_scenes.hpp"

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/simulation/table_top_scene.hpp"
#include "gfp/simulation/virtual_camera.hpp"

namespace gfp::bench {
namespace {

BenchScene synthetic_scene(std::uint64_t seed) {
  constexpr std::int32_t kTable = -2;
  const Capture seen = capture(table_top_scene({}, seed), default_kinect_camera(), look_at_pose({0, 0, 0.05}, 0.9, 0.7, -1.57), {}, seed);
  BenchScene scene{{"synthetic_" + std::to_string(seed), seen.frame.depth, seen.frame.camera, {}, Image<std::int32_t>(640, 480)}, {}, {}, {}};
  for (std::size_t i = 0; i < seen.truth.labels.pixels.size(); ++i) {
    const std::int32_t label = seen.truth.labels.pixels[i];
    if (label >= 0) scene.labelled.objects.pixels[i] = label + 2;
    if (label == kTable && seen.frame.depth.pixels.pixels[i] != 0) scene.table_pixels.push_back(i);
  }
  scene.table_normal_camera = seen.truth.T_world_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
  return scene;
}

std::vector<BenchScene> make_scenes(Source source) {
  std::vector<BenchScene> all;
  if (source == kSynthetic)
    for (const std::uint64_t seed : {7, 8, 9}) all.push_back(synthetic_scene(seed));
  else
    for (auto& labelled : test::read_osd_learn()) all.push_back({std::move(labelled), {}, {}, {}});
  for (BenchScene& scene : all) scene.cloud = depth_to_cloud(scene.labelled.depth, scene.labelled.camera);
  return all;
}

}  // namespace

const std::vector<BenchScene>& scenes(Source source) {
  static const std::vector<BenchScene> all[] = {make_scenes(kSynthetic), make_scenes(kReal)};
  return all[source];
}

const std::vector<BenchScene>& scenes(const benchmark::State& state) { return scenes(static_cast<Source>(state.range(0))); }

const std::vector<Frame>& standing_frames() {
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

bool has_real_frames() { return std::filesystem::exists(test::data_directory() / "scenes/osd_learn"); }

void each_source(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(kSynthetic);
  if (has_real_frames()) benchmark->Arg(kReal);
}

Turn::Turn(benchmark::State& state) : scenes_(scenes(state)) {
  state.SetLabel(std::to_string(scenes_.size()) + (state.range(0) == kReal ? " real frames" : " synthetic frames"));
}

}  // namespace gfp::bench
