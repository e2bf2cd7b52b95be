// The pipeline on frames that no sensor should deliver: an empty scene or a full one, never a crash, never memory without bound.
#include <gtest/gtest.h>

#include "app/builtin_library.hpp"
#include "fuzz/allocation_watch.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "support/table_frame.hpp"

namespace gfp {
namespace {

Frame frame_of(const CameraModel& camera, std::uint16_t reading) {
  Frame frame;
  frame.sensor = "hostile";
  frame.camera = camera;
  frame.depth.pixels = Image<std::uint16_t>(camera.width, camera.height, reading);
  return frame;
}

Scene scene_of(const Frame& frame, const std::string& profile = "robust") {
  PipelineOptions options;
  options.profile = profile;
  options.method = profile == "paper" ? "gfp_paper" : "gfp_robust";
  return process_frame(frame, {}, builtin_library(), options).scene;
}

class HostileFrames : public ::testing::TestWithParam<const char*> {};

TEST_P(HostileFrames, SmallConstantAndRandomOnesAreEmptyScenes) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 480}, {640, 1}, {2, 2}, {16, 16}})
    for (const std::uint16_t reading : {0, 1, 900, 65535}) {
      const Scene scene = scene_of(frame_of(default_kinect_camera(width, height), reading), GetParam());
      EXPECT_TRUE(scene.objects.empty()) << width << " x " << height << " of " << reading;
    }
  Random random(5);
  Frame noise = frame_of(default_kinect_camera(), 0);
  for (auto& pixel : noise.depth.pixels.pixels) pixel = static_cast<std::uint16_t>(random.below(65536));
  EXPECT_TRUE(scene_of(noise, GetParam()).objects.empty());
}

TEST_P(HostileFrames, CamerasThatDoNotFitGiveAnEmptyScene) {
  Frame frame = test::table_frame({{}});
  frame.camera.width = 320;  // not the image's
  EXPECT_TRUE(scene_of(frame, GetParam()).objects.empty());
  for (const double focal : {0.0, -525.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e-300}) {
    frame = test::table_frame({{}});
    frame.camera.fx = focal;
    EXPECT_TRUE(scene_of(frame, GetParam()).objects.empty()) << focal;
  }
  frame = test::table_frame({{}});
  frame.depth.scale_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(scene_of(frame, GetParam()).objects.empty());
}

// A true image of 10 000 pixels a side is beyond kMaxImageSide: refused by its camera, without a second copy of it.
TEST_P(HostileFrames, LargerThanAnyImageIsAnEmptySceneWithoutACopy) {
  Frame frame = frame_of(default_kinect_camera(), 0);
  frame.camera.width = frame.camera.height = 10'000;
  frame.depth.pixels = Image<std::uint16_t>(10'000, 10'000, 800);
  const test::AllocationWatch watch;
  EXPECT_TRUE(scene_of(frame, GetParam()).objects.empty());
  EXPECT_LT(watch.largest_bytes(), 64U << 20U);
  EXPECT_FALSE(validate(frame.camera));
  EXPECT_NE(validate(frame.camera).error().what.find("10000"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Profiles, HostileFrames, ::testing::Values("robust", "paper"));

// Two hundred boxes: as many as options.segmentation.max_segments are taken, the rest are named.
TEST(HostileScenes, MoreObjectsThanMaySegmentAreRejectedByName) {
  std::vector<test::TableBox> boxes;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) boxes.push_back({-0.25 + 0.1 * column, -0.25 + 0.1 * row, {0.04, 0.04, 0.05}, 0.2});
  PipelineOptions options;
  options.method = "superquadric";
  options.segmentation.max_segments = 20;
  const Scene scene = process_frame(test::table_frame(boxes, default_kinect_camera(), 0.9), {}, builtin_library(), options).scene;
  EXPECT_EQ(scene.objects.size(), 20U);
  EXPECT_GE(std::count_if(scene.rejected.begin(), scene.rejected.end(), [](const RejectedSegment& segment) { return segment.reason == "too_many"; }), 8);
}

// The paper's profile end to end: a closed model of each of three boxes, with the record of how its contour ran.
TEST(PaperProfile, FitsWhatStandsOnATable) {
  PipelineOptions options;
  options.profile = "paper";
  options.recognition.only_class = "box";
  for (const char* method : {"gfp_paper", "gfp_grid26", "sphere_snake"}) {
    options.method = method;
    const Scene scene = process_frame(test::table_frame({{-0.15, 0, {0.06, 0.06, 0.1}}, {0, 0.05, {0.08, 0.05, 0.12}}, {0.15, 0, {0.06, 0.09, 0.07}}}), {}, builtin_library(), options).scene;
    ASSERT_EQ(scene.objects.size(), 3U) << method;
    EXPECT_EQ(scene.profile, "paper");
    for (const SceneObject& object : scene.objects) {
      EXPECT_EQ(object.model.method, method);
      EXPECT_TRUE(object.closed) << method;
      EXPECT_EQ(static_cast<int>(object.model.energies.size()), object.model.iterations + 1);
      EXPECT_GT(object.model.evidence.fit_similarity, 0.2) << method;
    }
  }
}

}  // namespace
}  // namespace gfp
