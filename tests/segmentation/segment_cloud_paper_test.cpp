#include "gfp/segmentation/segment_cloud_paper.hpp"

#include <gtest/gtest.h>

#include "segmentation/toy_scene.hpp"

namespace gfp {
namespace {

// A box, a can and a cup, well apart, under a Kinect's noise: three clusters on one plane, whose frame is the table's.
TEST(SegmentCloudPaper, FindsWhatStandsApart) {
  test::ToyScene scene;
  scene.boxes = {{{-0.2, -0.05, 0}, {-0.12, 0.05, 0.1}, 0.3}};
  scene.cylinders = {{{0, 0}, 0.035, 0, 0.12}, {{0.18, 0.03}, 0.04, 0, 0.09, true}};
  const auto view = test::view(scene, 1.0);
  const Segments segments = segment_cloud_paper(view.cloud);
  ASSERT_EQ(segments.segments.size(), 3U);
  ASSERT_EQ(segments.planes.size(), 1U);
  const Eigen::Vector3d up = scene.T_world_camera().linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(segments.planes[0].T_camera_support.linear().col(2).dot(up), 0.9995);  // 1.8 degrees
  EXPECT_NEAR((scene.T_world_camera() * segments.planes[0].T_camera_support.translation()).z(), 0, 0.004);
  for (const Segment& segment : segments.segments) {
    std::map<int, int> votes;
    for (const auto i : segment.pixels) ++votes[view.truth.pixels[static_cast<std::size_t>(i)]];
    const auto most = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    EXPECT_GE(most->first, 0);
    EXPECT_GT(most->second, 0.97 * static_cast<double>(segment.pixels.size()));
    EXPECT_EQ(segment.support, 0);
    EXPECT_GT(segment.height_m, 0.08);
    EXPECT_FALSE(segment.touches_border);
  }
}

// What touches is one cluster: the paper's way, and a reason for `robust`.
TEST(SegmentCloudPaper, MergesWhatTouches) {
  test::ToyScene scene;
  scene.boxes = {{{-0.08, -0.05, 0}, {0, 0.05, 0.1}}, {{0, -0.05, 0}, {0.08, 0.05, 0.08}}};
  EXPECT_EQ(segment_cloud_paper(test::view(scene).cloud).segments.size(), 1U);
}

TEST(SegmentCloudPaper, EmptyTablesWallsAndNothingAreResults) {
  const Segments table = segment_cloud_paper(test::view(test::ToyScene{}, 1.0).cloud);
  EXPECT_TRUE(table.segments.empty());
  EXPECT_EQ(table.planes.size(), 1U);
  EXPECT_TRUE(segment_cloud_paper({}).segments.empty());
  OrganizedCloud blind = test::view(test::ToyScene{}).cloud;
  for (auto* plane : {&blind.x, &blind.y, &blind.z}) plane->assign(plane->size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(segment_cloud_paper(blind).planes.empty());
}

TEST(SegmentCloudPaper, TakesTheUsersMask) {
  test::ToyScene scene;
  scene.cylinders = {{{0, 0}, 0.035, 0, 0.12}};
  const auto view = test::view(scene);
  Image<std::uint8_t> mask(view.cloud.width, view.cloud.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = view.truth.pixels[i] == 0 ? 255 : 0;
  const Segments segments = segment_cloud_paper(view.cloud, {}, std::nullopt, mask);
  ASSERT_EQ(segments.segments.size(), 1U);
  EXPECT_EQ(segments.segments[0].support, 0);
  for (const auto i : segments.segments[0].pixels) ASSERT_EQ(view.truth.pixels[static_cast<std::size_t>(i)], 0);
}

}  // namespace
}  // namespace gfp
