#include "gfp/segmentation/segment_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "gfp/simulation/virtual_camera.hpp"
#include "segmentation/toy_scene.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

using test::ToyScene;

ToyScene box_and_can() {
  ToyScene scene;
  scene.boxes.push_back({{-0.22, -0.03, 0.0}, {-0.12, 0.03, 0.15}, 0.4});
  scene.cylinders.push_back({{0.12, 0.02}, 0.035, 0.0, 0.11});
  return scene;
}

// IoU of segment `s` with what the truth says of `label`.
double overlap(const Segments& segments, int s, const Image<std::int32_t>& truth, int label) {
  int both = 0, either = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const bool ours = segments.labels.pixels[i] == s, theirs = truth.pixels[i] == label;
    both += ours && theirs;
    either += ours || theirs;
  }
  return either == 0 ? 0.0 : static_cast<double>(both) / either;
}

double best_overlap(const Segments& segments, const Image<std::int32_t>& truth, int label) {
  double best = 0;
  for (int s = 0; s < static_cast<int>(segments.segments.size()); ++s) best = std::max(best, overlap(segments, s, truth, label));
  return best;
}

TEST(SegmentCloud, FindsTheTableAndWhatStandsOnIt) {
  const ToyScene scene = box_and_can();
  const auto seen = test::view(scene, 1.0);
  const Segments segments = segment_cloud(seen.cloud);
  ASSERT_GE(segments.planes.size(), 1U);
  ASSERT_EQ(segments.segments.size(), 2U);
  EXPECT_GT(best_overlap(segments, seen.truth, 0), 0.93);
  EXPECT_GT(best_overlap(segments, seen.truth, 1), 0.93);

  const Transform T_support_world = segments.planes[0].T_camera_support.inverse() * scene.T_world_camera().inverse();
  EXPECT_NEAR(T_support_world.linear()(2, 2), 1.0, 1e-4);              // the right side up, within 0.8 deg
  EXPECT_NEAR((T_support_world * Eigen::Vector3d::Zero()).z(), 0.0, 1e-3);
  for (const Segment& segment : segments.segments) {
    EXPECT_EQ(segment.support, 0);
    EXPECT_FALSE(segment.touches_border || segment.occluded || segment.top_cut);
    EXPECT_TRUE(std::is_sorted(segment.pixels.begin(), segment.pixels.end()));
    const int label = seen.truth.pixels[static_cast<std::size_t>(segment.pixels[segment.pixels.size() / 2])];
    EXPECT_NEAR(segment.height_m, label == 0 ? 0.15 : 0.11, 0.004);
  }
}

TEST(SegmentCloud, ThePolygonIsTheSeenTable) {
  ToyScene scene;
  scene.table_half_x = 0.2;
  scene.table_half_y = 0.15;
  scene.cylinders.push_back({{0.0, 0.0}, 0.03, 0.0, 0.1});  // what the table carries makes it the first of the planes
  const Segments segments = segment_cloud(test::view(scene, 1.0).cloud);
  ASSERT_GE(segments.planes.size(), 1U);
  const Transform T_world_support = scene.T_world_camera() * segments.planes[0].T_camera_support;
  double area = 0;
  const auto& polygon = segments.planes[0].polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    const Eigen::Vector3d world = T_world_support * Eigen::Vector3d(a.x(), a.y(), 0);
    EXPECT_LE(std::abs(world.x()), 0.21);
    EXPECT_LE(std::abs(world.y()), 0.16);
  }
  EXPECT_NEAR(area, 0.4 * 0.3, 0.02);  // counter-clockwise: positive; two samples' pitch on every side
}

TEST(SegmentCloud, AnEmptyTableIsAResult) {
  ToyScene scene;
  scene.wall_y = 0.8;
  const Segments segments = segment_cloud(test::view(scene, 1.0).cloud);
  EXPECT_GE(segments.planes.size(), 1U);
  EXPECT_TRUE(segments.segments.empty());
}

TEST(SegmentCloud, NothingOnWallTableOrFloorBecomesASegment) {
  for (const double wall_y : {0.36, 0.5, 0.9}) {
    ToyScene scene = box_and_can();
    scene.wall_y = wall_y;
    const auto seen = test::view(scene, 1.0, 3);
    const Segments segments = segment_cloud(seen.cloud);
    ASSERT_EQ(segments.segments.size(), 2U) << "wall at " << wall_y;
    std::map<int, int> below;
    for (const Segment& segment : segments.segments)
      for (const auto i : segment.pixels) ++below[std::min(0, seen.truth.pixels[static_cast<std::size_t>(i)])];
    EXPECT_LE(below[-2] + below[-3] + below[-4], 100) << "wall at " << wall_y;  // noise at the rims
  }
}

TEST(SegmentCloud, SaysWhatIsCutAndWhatIsHidden) {
  ToyScene scene;
  scene.boxes.push_back({{-0.05, -0.20, 0.0}, {0.05, -0.12, 0.10}});   // in front,
  scene.boxes.push_back({{-0.02, -0.06, 0.0}, {0.14, 0.02, 0.12}});    // half behind it,
  scene.cylinders.push_back({{-0.36, -0.12}, 0.06, 0.0, 0.2});         // and one that the image cuts
  const auto seen = test::view(scene, 1.0);
  const Segments segments = segment_cloud(seen.cloud);
  ASSERT_EQ(segments.segments.size(), 3U);
  for (const Segment& segment : segments.segments) {
    const int label = seen.truth.pixels[static_cast<std::size_t>(segment.pixels[segment.pixels.size() / 2])];
    EXPECT_EQ(segment.occluded, label == 1) << label;
    EXPECT_EQ(segment.touches_border, label == 2) << label;
  }
}

// Two things that touch meet in a valley; one thing does not.
TEST(SegmentCloud, DividesWhatTouchesInAValley) {
  ToyScene scene;
  scene.boxes.push_back({{-0.16, -0.05, 0.0}, {-0.04, 0.05, 0.12}, 0.3});
  scene.cylinders.push_back({{0.03, -0.02}, 0.055, 0.0, 0.16});
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto seen = test::view(scene, 1.0, seed);
    const Segments segments = segment_cloud(seen.cloud);
    EXPECT_EQ(segments.segments.size(), 2U) << "seed " << seed;
    EXPECT_GT(best_overlap(segments, seen.truth, 0), 0.9) << "seed " << seed;
    EXPECT_GT(best_overlap(segments, seen.truth, 1), 0.9) << "seed " << seed;
  }
}

// Outer wall, inner wall and floor of a bowl are one object, although the near rim parts them in the image.
TEST(SegmentCloud, KeepsHollowThingsWhole) {
  for (const auto& [radius, height] : {std::pair{0.08, 0.09}, {0.045, 0.10}}) {
    ToyScene scene;
    scene.cylinders.push_back({{0.05, 0.0}, radius, 0.0, height, true});
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const auto seen = test::view(scene, 1.0, seed);
      const Segments segments = segment_cloud(seen.cloud);
      EXPECT_EQ(segments.segments.size(), 1U) << "radius " << radius << " seed " << seed;
      EXPECT_GT(best_overlap(segments, seen.truth, 0), 0.9) << "radius " << radius << " seed " << seed;
    }
  }
}

/// How well the mesh is covered where it stands alone on a virtual table, seen from this elevation. Its outline has no readings: a twentieth to a tenth.
double overlap_on_table(const TriangleMesh& mesh, double elevation_rad) {
  VirtualScene scene;
  scene.objects.push_back({.name = "thing", .class_name = "thing", .mesh = mesh});
  const Capture seen = capture(scene, default_kinect_camera(), look_at_pose({0, 0, 0.02}, 0.8, elevation_rad, 0.3), {}, 1);
  return best_overlap(segment_cloud(depth_to_cloud(seen.frame.depth, seen.frame.camera)), seen.truth.labels, 0);
}

// The middle of a plate is wide, flat and 2.5 mm above the table: no warp of it. Inside a ring is the table.
TEST(SegmentCloud, ThePlateHasAMiddle) {
  const TriangleMesh plate = test::revolve({{0.08, 0}, {0.13, 0.022}, {0.13, 0.025}, {0.09, 0.012}, {0.08, 0.0025}}, 64);
  for (const double elevation_rad : {0.6, 0.8, 1.0}) EXPECT_GT(overlap_on_table(plate, elevation_rad), 0.9) << elevation_rad;
}

// From above a flared rim hides the top of the wall below it.
TEST(SegmentCloud, AFlaredRimBelongsToItsWall) {
  const TriangleMesh mug = test::revolve({{0.030, 0}, {0.033, 0.068}, {0.044, 0.080}, {0.041, 0.081}, {0.030, 0.068}, {0.026, 0.006}}, 64);
  for (const double elevation_rad : {0.6, 0.8, 1.0, 1.1}) EXPECT_GT(overlap_on_table(mug, elevation_rad), 0.85) << elevation_rad;
}

// Through a narrow mouth the inside is seen without the wall between.
TEST(SegmentCloud, WhatIsSeenThroughAMouthIsTheInside) {
  const TriangleMesh vase = test::revolve({{0.05, 0}, {0.09, 0.10}, {0.06, 0.20}, {0.050, 0.22}, {0.065, 0.25}, {0.062, 0.25}, {0.046, 0.22}, {0.056, 0.20}, {0.086, 0.10}, {0.046, 0.01}}, 64);
  for (const double elevation_rad : {0.6, 0.8, 1.0, 1.1}) EXPECT_GT(overlap_on_table(vase, elevation_rad), 0.85) << elevation_rad;
}

// A body on a narrower grip overhangs it.
TEST(SegmentCloud, WhatOverhangsStandsOnWhatIsBelow) {
  const TriangleMesh tee = test::revolve({{0.025, 0}, {0.022, 0.10}, {0.05, 0.105}, {0.05, 0.16}}, 64);
  for (const double elevation_rad : {0.6, 0.8, 1.0}) EXPECT_GT(overlap_on_table(tee, elevation_rad), 0.85) << elevation_rad;
}

// A box that shows on all sides of a nearer one is not the inside of that.
TEST(SegmentCloud, WhatShowsAllAroundIsBehind) {
  ToyScene scene;
  scene.boxes.push_back({{-0.07, -0.10, 0.0}, {0.07, -0.05, 0.20}, 0.0});
  scene.boxes.push_back({{-0.11, 0.03, 0.0}, {0.11, 0.07, 0.26}, 0.0});
  const auto seen = test::view(scene, 1.0, 1);
  const Segments segments = segment_cloud(seen.cloud);
  EXPECT_EQ(segments.segments.size(), 2U);
  for (const int box : {0, 1}) EXPECT_GT(best_overlap(segments, seen.truth, box), 0.9) << box;
}

TEST(SegmentCloud, InsideARingIsTheTable) {
  TriangleMesh ring = test::torus(0.12, 0.02);
  for (auto& v : ring.vertices) v.z() += 0.02;
  for (const double elevation_rad : {0.6, 0.8, 1.0}) EXPECT_GT(overlap_on_table(ring, elevation_rad), 0.85) << elevation_rad;
}

// A box that a nearer, slimmer one divides in the image stays one object.
TEST(SegmentCloud, JoinsWhatANearerObjectDivides) {
  ToyScene scene;
  scene.boxes.push_back({{-0.13, 0.06, 0.0}, {0.13, 0.14, 0.07}});
  scene.boxes.push_back({{-0.02, -0.16, 0.0}, {0.02, -0.10, 0.24}});
  const auto seen = test::view(scene, 1.0);
  const Segments segments = segment_cloud(seen.cloud);
  EXPECT_EQ(segments.segments.size(), 2U);
  EXPECT_GT(best_overlap(segments, seen.truth, 0), 0.9);
  EXPECT_GT(best_overlap(segments, seen.truth, 1), 0.9);
}

TEST(SegmentCloud, RejectsWithAReason) {
  ToyScene scene;
  scene.cylinders.push_back({{-0.2, 0.05}, 0.17, 0.0, 0.1});
  scene.boxes.push_back({{0.0, -0.1, 0.0}, {0.02, -0.09, 0.02}});
  SegmentationOptions options;
  options.min_points = 800;
  options.max_size_m = 0.3;
  const Segments segments = segment_cloud(test::view(scene, 0.0).cloud, options);
  EXPECT_TRUE(segments.segments.empty());
  std::map<std::string, int> reasons;
  for (const auto& rejected : segments.rejected) ++reasons[rejected.reason];
  EXPECT_EQ(reasons["too_large"], 1);
  EXPECT_EQ(reasons["too_small"], 1);
}

TEST(SegmentCloud, AMaskIsTheOneSegment) {
  const auto seen = test::view(box_and_can(), 1.0);
  Image<std::uint8_t> mask(640, 480);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = seen.truth.pixels[i] == 1;
  const Segments segments = segment_cloud(seen.cloud, {}, std::nullopt, nullptr, mask);
  ASSERT_EQ(segments.segments.size(), 1U);
  EXPECT_DOUBLE_EQ(overlap(segments, 0, seen.truth, 1), 1.0);
  EXPECT_NEAR(segments.segments[0].height_m, 0.11, 0.004);
}

OrganizedCloud constant_cloud(int width, int height, float value) {
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  cloud.camera = default_kinect_camera(width, height);
  cloud.x = cloud.y = cloud.z = std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
  return cloud;
}

TEST(SegmentCloud, AnswersEmptyAndAbsurdFramesWithNothing) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(segment_cloud({}).segments.empty());
  for (const float value : {nan, 0.0F, -1.0F, 1e30F, inf, -inf, 1e-30F})
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 480}, {640, 1}, {7, 5}, {640, 480}}) {
      const Segments segments = segment_cloud(constant_cloud(width, height, value));
      EXPECT_TRUE(segments.segments.empty()) << value << " " << width << "x" << height;
      EXPECT_EQ(segments.labels.pixels.size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    }
}

}  // namespace
}  // namespace gfp
