// One recording, played at any speed on any number of threads, gives the same objects bit by bit.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "app/builtin_library.hpp"
#include "gfp/core/sha256.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "gfp/recording/recording_file.hpp"
#include "replay/mcap_source.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic/synthetic_source.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

constexpr int kFrames = 5;

std::filesystem::path record_synthetic(const test::TemporaryFolder& folder) {
  SyntheticOptions options;
  options.sensor = "virtual";
  options.seed = 5;
  options.rate_hz = 0;
  options.table.objects = 2;
  SyntheticSource source(options);
  EXPECT_TRUE(source.open());
  const auto path = folder / "table.mcap";
  auto file = RecordingFile::create(path);
  wire::RecordingMessages messages(RecordContent{});
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = source.grab(10s);
    EXPECT_TRUE(frame) << frame.error().what;
    messages.put(*frame, Nanoseconds(1'700'000'000'000'000'000) + i * 33'333'333ns, [&](const McapChannelSpec& spec, const McapMessage& message) { EXPECT_TRUE(file->put(spec, message)); });
  }
  EXPECT_TRUE(file->finish());
  return path;
}

void put(const Transform& pose, Sha256& hash) {
  for (Eigen::Index i = 0; i < 16; ++i) hash.put_value(pose.matrix().data()[i]);
}

void put(const Scene& scene, Sha256& hash) {
  hash.put_value(scene.stamps.sensor.count());
  hash.put_value(scene.objects.size());
  for (const SceneObject& object : scene.objects) {
    hash.put_value(object.id);
    hash.put(std::as_bytes(std::span(object.model.class_name)));
    put(object.model.T_camera_object, hash);
    for (const Eigen::Vector3d& vertex : object.model.vertices)
      for (Eigen::Index i = 0; i < 3; ++i) hash.put_value(vertex[i]);
    hash.put_values(object.model.states);
    hash.put_values(object.model.sigma_m);
    for (const Grasp& grasp : object.grasps.grasps) {
      put(grasp.T_camera_tcp, hash);
      hash.put_value(grasp.epsilon);
      hash.put_value(grasp.p_force_closure);
    }
  }
}

struct Played {
  std::uint64_t hash = 0;
  std::size_t frames = 0, objects = 0;
};

Played play(const std::filesystem::path& file, double speed, int threads) {
  ReplayOptions replay;
  replay.sensor = "virtual";
  replay.speed = speed;
  replay.frame_time = true;
  auto source = open_mcap(file, replay);
  EXPECT_TRUE(source && (*source)->open());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  SceneMemory memory;
  Sha256 hash;
  Played played;
  while (true) {
    const auto frame = (*source)->grab(10s);
    if (!frame) break;
    PipelineResult result = arena.execute([&] { return process_frame(*frame, memory, builtin_library(), PipelineOptions{}); });
    put(result.scene, hash);
    ++played.frames;
    played.objects += result.scene.objects.size();
    memory = std::move(result.memory);
  }
  played.hash = hash.digest64();
  return played;
}

TEST(ReplayDeterminism, SameObjectsAtAnySpeedOnAnyNumberOfThreads) {
  const test::TemporaryFolder folder;
  const auto file = record_synthetic(folder);
  const Played reference = play(file, 0, 1);
  ASSERT_EQ(reference.frames, static_cast<std::size_t>(kFrames));
  ASSERT_GT(reference.objects, 0U);
  for (const auto& [speed, threads] : {std::pair(0.0, 2), std::pair(0.0, 4), std::pair(0.5, 2), std::pair(1.0, 4)}) {
    const Played again = play(file, speed, threads);
    EXPECT_EQ(again.frames, reference.frames);
    EXPECT_EQ(again.hash, reference.hash) << "speed " << speed << ", " << threads << " threads";
  }
}

}  // namespace
}  // namespace gfp
