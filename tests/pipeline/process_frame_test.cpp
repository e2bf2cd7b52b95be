#include "gfp/pipeline/process_frame.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include "pipeline/stage_doubles.hpp"

namespace gfp {
namespace {

using test::Block;
using test::block_frame;
using test::script;

class ProcessFrame : public ::testing::Test {
 protected:
  ProcessFrame() { script().reset(); }

  PrimitiveLibrary library = test::library_of({"box", "can"});
  const std::vector<Block> far_apart{{{10, 30, 30, 50}, 0.80}, {{130, 30, 150, 50}, 0.81}};
};

TEST_F(ProcessFrame, AnEmptyTableIsAScene) {
  const PipelineResult result = process_frame(block_frame({}, 7), {}, library);
  EXPECT_TRUE(result.scene.objects.empty());
  EXPECT_TRUE(result.scene.support.has_value());
  EXPECT_EQ(result.scene.sequence, 7U);
  EXPECT_EQ(result.scene.sensor, "blocks");
  EXPECT_EQ(result.memory.frames, 1U);
}

TEST_F(ProcessFrame, FirstAddsThenLeavesAloneWhatDidNotChange) {
  const PipelineResult first = process_frame(block_frame(far_apart), {}, library);
  ASSERT_EQ(first.scene.objects.size(), 2U);
  EXPECT_EQ(first.scene.objects[0].status, ObjectStatus::kAdded);
  EXPECT_EQ(script().planned, 2);

  script().reset();
  const PipelineResult second = process_frame(block_frame(far_apart, 1), first.memory, library);
  ASSERT_EQ(second.scene.objects.size(), 2U);
  EXPECT_EQ(second.scene.objects[1].status, ObjectStatus::kUnchanged);
  EXPECT_EQ(second.scene.objects[1].model.vertices, first.scene.objects[1].model.vertices);
  EXPECT_EQ(script().registered + script().contoured + script().superquadrics + script().planned, 0) << "a static scene costs nothing";
}

// As when a person says which of a primitive's vertices are control points: what stands is fitted with them at once.
TEST_F(ProcessFrame, WhatStandsIsFittedAnewWhenItsPrimitiveIsAnother) {
  const PipelineResult first = process_frame(block_frame(far_apart), {}, library);
  ASSERT_EQ(first.scene.objects.size(), 2U);
  const std::string fitted = first.scene.objects[0].model.primitive->name;
  std::vector<PrimitivePtr> primitives;
  for (const PrimitivePtr& primitive : library.all()) {
    auto made = std::make_shared<Primitive>(*primitive);
    if (made->name == fitted) ++made->content_hash;
    primitives.push_back(std::move(made));
  }
  const PrimitiveLibrary retyped(std::move(primitives));
  script().reset();
  const PipelineResult second = process_frame(block_frame(far_apart, 1), first.memory, retyped);
  ASSERT_EQ(second.scene.objects.size(), 2U);
  EXPECT_EQ(second.scene.objects[0].id, first.scene.objects[0].id);
  EXPECT_EQ(second.scene.objects[0].status, ObjectStatus::kUpdated);
  EXPECT_EQ(second.scene.objects[0].model.primitive->content_hash, retyped.find(fitted)->content_hash);
  EXPECT_EQ(script().recognised, 2) << "both are fits of it";
  script().reset();
  EXPECT_EQ(process_frame(block_frame(far_apart, 2), second.memory, retyped).scene.objects[0].status, ObjectStatus::kUnchanged);
  EXPECT_EQ(script().recognised, 0);
}

TEST_F(ProcessFrame, RefitsOnlyWhatMoved) {
  const PipelineResult first = process_frame(block_frame(far_apart), {}, library);
  auto moved = far_apart;
  moved[0].rect = {14, 30, 34, 50};
  script().reset();
  const PipelineResult second = process_frame(block_frame(moved), first.memory, library);
  EXPECT_EQ(second.scene.objects[0].status, ObjectStatus::kUpdated);
  EXPECT_EQ(second.scene.objects[1].status, ObjectStatus::kUnchanged);
  EXPECT_EQ(script().followed, 1);
  EXPECT_EQ(script().contoured + script().recognised, 0) << "it is followed, neither shaped anew nor searched";
  EXPECT_EQ(script().planned, 0) << "its grasps moved with it";
  EXPECT_EQ(second.scene.objects[0].class_probabilities, first.scene.objects[0].class_probabilities) << "nothing new was learnt of the class";
}

TEST_F(ProcessFrame, SaysWhatIsGoneAndKnowsItWhenItIsBack) {
  const PipelineResult both = process_frame(block_frame(far_apart), {}, library);
  const PipelineResult one = process_frame(block_frame({far_apart[1]}), both.memory, library);
  EXPECT_EQ(one.scene.lost, std::vector<std::uint64_t>{1});
  ASSERT_EQ(one.scene.objects.size(), 1U);
  EXPECT_EQ(one.scene.objects[0].id, 2U);
  const PipelineResult back = process_frame(block_frame(far_apart), one.memory, library);
  ASSERT_EQ(back.scene.objects.size(), 2U);
  EXPECT_EQ(back.scene.objects[0].id, 1U);
  EXPECT_TRUE(back.scene.lost.empty());
}

TEST_F(ProcessFrame, GraspsKnowTheNeighbours) {
  const std::vector<Block> close{{{40, 30, 60, 50}, 0.80}, {{64, 30, 84, 50}, 0.81}};
  EXPECT_EQ(process_frame(block_frame(close), {}, library).scene.objects[0].grasps.no_grasp_reason, "1 neighbours");
}

// They stand 0.7 m apart, more than a gripper reaches.
TEST_F(ProcessFrame, GraspsStandWhenSomethingFarAwayLeaves) {
  const PipelineResult both = process_frame(block_frame(far_apart), {}, library);
  script().reset();
  const PipelineResult one = process_frame(block_frame({far_apart[1]}), both.memory, library);
  EXPECT_EQ(one.scene.objects[0].status, ObjectStatus::kUnchanged);
  EXPECT_EQ(script().planned, 0);
}

TEST_F(ProcessFrame, GraspsAreNewWhenANeighbourLeaves) {
  const std::vector<Block> close{{{40, 30, 60, 50}, 0.80}, {{64, 30, 84, 50}, 0.81}};
  const PipelineResult both = process_frame(block_frame(close), {}, library);
  const PipelineResult one = process_frame(block_frame({close[1]}), both.memory, library);
  EXPECT_EQ(one.scene.objects[0].grasps.no_grasp_reason, "0 neighbours");
}

// Names of unknown methods are refused before any frame; should one arrive all the same, it costs the segments, not the frame.
TEST_F(ProcessFrame, WhatCannotBeFittedIsRejectedWithAReason) {
  PipelineOptions options;
  options.method = "guess";
  const PipelineResult result = process_frame(block_frame(far_apart), {}, library, options);
  EXPECT_TRUE(result.scene.objects.empty());
  ASSERT_EQ(result.scene.rejected.size(), 2U);
  EXPECT_EQ(result.scene.rejected[0].reason, "no_fit");
  EXPECT_EQ(result.scene.rejected[0].pixels, 400);
}

TEST_F(ProcessFrame, GivesTheSameAtAnyThreadCount) {
  std::vector<Block> blocks;
  for (int i = 0; i < 12; ++i) blocks.push_back({{12 * i + 2, 30, 12 * i + 12, 50}, 0.80 + 0.002 * i});
  std::vector<Scene> scenes;
  for (const int threads : {1, 2, 4}) {
    oneapi::tbb::task_arena arena(threads);
    scenes.push_back(arena.execute([&] { return process_frame(block_frame(blocks), {}, library).scene; }));
  }
  for (const Scene& scene : scenes) {
    ASSERT_EQ(scene.objects.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(scene.objects[i].id, i + 1);
      EXPECT_EQ(scene.objects[i].model.T_camera_object.matrix(), scenes[0].objects[i].model.T_camera_object.matrix());
      EXPECT_EQ(scene.objects[i].grasps.no_grasp_reason, scenes[0].objects[i].grasps.no_grasp_reason);
    }
  }
}

}  // namespace
}  // namespace gfp
