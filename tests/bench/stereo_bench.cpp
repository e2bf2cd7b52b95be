// Rectified pair to disparity: ours beside OpenCV's SGBM_3WAY, on one thread each, with the share of wrong matches on the aloe pair.
#include <benchmark/benchmark.h>

#include <cmath>

#include "bench/peers_opencv_stereo.hpp"
#include "gfp/cloud/stereo_to_depth.hpp"
#include "support/data_folder.hpp"

namespace gfp::bench {
namespace {

constexpr int kFullWidth = 1282, kFullHeight = 1110;

struct Pair {
  Image<std::uint8_t> left, right, truth;
  double truth_scale = 1;  ///< Pixels of these pictures per grey value of the truth.
  int min_disparity = 0, disparities = 64;
};

/// 640 x 480 with 64 disparities for the time; half of the original with 96 for the errors.
const Pair& pair_of(bool for_errors) {
  static const auto make = [](int width, int height, int min_disparity, int disparities) {
    const auto folder = test::data_folder() / "stereo" / "opencv_aloe";
    return Pair{read_scaled(folder / "aloeL.jpg", width, height), read_scaled(folder / "aloeR.jpg", width, height), read_scaled(folder / "aloeGT.png", kFullWidth, kFullHeight),
                static_cast<double>(width) / kFullWidth, min_disparity, disparities};
  };
  static const Pair kPairs[] = {make(640, 480, 16, 64), make(kFullWidth / 2, kFullHeight / 2, 16, 96)};
  return kPairs[for_errors ? 1 : 0];
}

template <class DisparityAt>
void report_errors(benchmark::State& state, const Pair& pair, DisparityAt&& disparity_at) {
  int known = 0, matched = 0, bad = 0;
  for (int v = 0; v < pair.left.height; ++v)
    for (int u = 0; u < pair.left.width; ++u) {
      const int truth = pair.truth.at(2 * u, 2 * v);
      if (truth == 0) continue;
      ++known;
      const double disparity = disparity_at(u, v);
      if (disparity < pair.min_disparity) continue;
      ++matched;
      bad += std::abs(disparity - pair.truth_scale * truth) > 2 ? 1 : 0;
    }
  state.counters["matched_%"] = 100.0 * matched / known;
  state.counters["bad2_of_matched_%"] = 100.0 * bad / matched;
  state.counters["bad2_or_none_%"] = 100.0 * (known - matched + bad) / known;
}

void BM_StereoOurs(benchmark::State& state) {
  const Pair& pair = pair_of(state.range(0) != 0);
  StereoOptions options;
  options.min_disparity_px = pair.min_disparity;
  options.disparities = pair.disparities;
  Result<DisparityImage> found = failure(ErrorCode::kTimeout, "");
  for (auto _ : state) found = match_stereo(pair.left, pair.right, options);
  if (state.range(0) != 0) report_errors(state, pair, [&](int u, int v) { return found->pixels.at(u, v) / static_cast<double>(kDisparityUnits); });
}

void BM_StereoOpencvSgbm3way(benchmark::State& state) {
  const Pair& pair = pair_of(state.range(0) != 0);
  const OpencvStereo opencv(pair.min_disparity, pair.disparities);
  Image<std::int16_t> found;
  for (auto _ : state) found = opencv.match(pair.left, pair.right);
  if (state.range(0) != 0) report_errors(state, pair, [&](int u, int v) { return found.at(u, v) / 16.0; });
}

void where_there_is_data(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("errors")->Unit(benchmark::kMillisecond);
  if (std::filesystem::exists(test::data_folder() / "stereo" / "opencv_aloe")) benchmark->Arg(0)->Arg(1);
}
BENCHMARK(BM_StereoOurs)->Apply(where_there_is_data);
BENCHMARK(BM_StereoOpencvSgbm3way)->Apply(where_there_is_data);

}  // namespace
}  // namespace gfp::bench
