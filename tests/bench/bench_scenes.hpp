#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"
#include "segmentation/labelled_scene.hpp"

namespace gfp::bench {

/// A frame with what is known about it.
struct BenchScene {
  test::LabelledScene labelled;
  std::vector<std::size_t> table_pixels;  ///< Synthetic scenes only: they lie on the table...
  Eigen::Vector3d table_normal_camera = Eigen::Vector3d::Zero();  ///< ...whose normal towards the camera is this.
  OrganizedCloud cloud;                   ///< Ours, for the stages behind it.
};

enum Source { kSynthetic = 0, kReal = 1 };

/// Synthetic: three seeded tables with five objects each, as a Kinect sees them. Real: the labelled Kinect frames of
/// $GFP_DATA_DIR; empty where they are absent.
const std::vector<BenchScene>& scenes(Source source);
const std::vector<BenchScene>& scenes(const benchmark::State& state);

/// Twelve frames of one standing table with five objects, 640 x 480, each with its own Kinect noise; sequences from 1.
const std::vector<Frame>& standing_frames();

/// Asked while benchmarks are registered, when nothing else of the program may run yet.
bool has_real_frames();

/// One argument: the source; the real frames only where they are.
void each_source(benchmark::internal::Benchmark* benchmark);

/// Takes the scenes in turn; names the source in the report.
class Turn {
 public:
  explicit Turn(benchmark::State& state);
  const BenchScene& next() { return scenes_[at_++ % scenes_.size()]; }
  std::size_t index() const { return at_ % scenes_.size(); }

 private:
  const std::vector<BenchScene>& scenes_;
  std::size_t at_ = 0;
};

}  // namespace gfp::bench
