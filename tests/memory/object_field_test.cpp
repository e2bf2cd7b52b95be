#include "gfp/memory/object_field.hpp"

#include <gtest/gtest.h>

#include "support/shapes.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A mug-sized can on a table, seen by a sensor at `azimuth_deg`.
struct Shot {
  Transform T_world_sensor;
  ObjectView view;
};

Shot shot(double azimuth_deg, const Eigen::Vector3d& place = Eigen::Vector3d::Zero(), std::uint64_t noise = 1, double elevation_deg = 30) {
  const Transform T_world_camera = test::look_at({0, 0, 0.05}, 0.8, elevation_deg * kDegree, azimuth_deg * kDegree);
  const TriangleMesh can = transformed(test::box({0.08, 0.06, 0.1}), Transform(Eigen::Translation3d(place)));
  return {T_world_camera, test::view_of(can, default_kinect_camera(), T_world_camera, {.noise_scale = 1, .seed = noise})};
}

ObjectField field_of(const std::vector<double>& azimuths_deg, const AssociateOptions& options = {}) {
  ObjectField field;
  for (const double azimuth : azimuths_deg) {
    const Shot seen = shot(azimuth);
    field = remember_view(std::move(field), "arm", seen.T_world_sensor, seen.view, options);
  }
  return field;
}

TEST(ObjectField, KeepsDirectionsThatAreApart) {
  EXPECT_EQ(field_of({0}).size(), 1U);
  EXPECT_EQ(field_of({0, 5, 10}).size(), 1U) << "nothing new to be seen";
  EXPECT_EQ(field_of({0, 40, 80}).size(), 3U);
}

TEST(ObjectField, NeverGrowsBeyondItsBound) {
  std::vector<double> around;
  for (int k = 0; k < 72; ++k) around.push_back(20.0 * k);
  const ObjectField field = field_of(around);
  EXPECT_EQ(field.size(), 4U);
  for (const FieldView& seen : field) {
    EXPECT_TRUE(seen.view->field.empty());
    EXPECT_FALSE(seen.view->warm_start.has_value());
  }
  EXPECT_TRUE(field_of(around, {.field_views = 0}).empty());
}

// A standing sensor that sees the same again has nothing to say; what it sees of a moved object takes the old view's place.
TEST(ObjectField, AStandpointHasOneView) {
  ObjectField field = field_of({0});
  const auto first = field[0].view;
  const Shot again = shot(0, {0, 0, 0}, 2);
  field = remember_view(std::move(field), "arm", again.T_world_sensor, again.view);
  ASSERT_EQ(field.size(), 1U);
  EXPECT_EQ(field[0].view, first) << "the same within noise";
  const Shot moved = shot(0, {0.02, 0.01, 0}, 3);
  field = remember_view(std::move(field), "arm", moved.T_world_sensor, moved.view);
  ASSERT_EQ(field.size(), 1U);
  EXPECT_NE(field[0].view, first);
}

TEST(ObjectField, OffersTheFarthestDirectionsFirst) {
  const ObjectField field = field_of({0, 40, 170, -60});
  const Shot now = shot(10);
  const std::vector<Sighting> offered = sightings(field, "arm", now.T_world_sensor, now.view);
  ASSERT_EQ(offered.size(), 2U);
  EXPECT_EQ(offered[0].view, field[2].view);
  EXPECT_EQ(offered[1].view, field[3].view);
  for (const Sighting& sighting : offered)  // the table is one table, whoever sees it
    EXPECT_TRUE((sighting.T_sighting_camera * now.view.T_camera_support).isApprox(sighting.view->T_camera_support, 1e-9));
  EXPECT_TRUE(sightings(field_of({0}), "arm", shot(3).T_world_sensor, shot(3).view).empty()) << "its own direction says nothing more";
}

// What was seen before the object was pushed no longer holds. From right across, a box that was pushed along the line of sight could as well be
// thinner or thicker: only a sensor that stood there before knows better.
TEST(ObjectField, WhatContradictsTheFrameIsLeftOut) {
  for (const double azimuth : {30.0, 60.0, 90.0, 120.0, 180.0}) {
    const ObjectField field = field_of({azimuth});
    for (const std::uint64_t noise : {2U, 3U})
      EXPECT_EQ(sightings(field, "arm", shot(0).T_world_sensor, shot(0, {0, 0, 0}, noise).view).size(), 1U) << azimuth << " degrees, nothing moved";
    for (const Eigen::Vector3d& push : {Eigen::Vector3d(0.03, 0, 0), Eigen::Vector3d(0, 0.03, 0), Eigen::Vector3d(-0.03, 0, 0), Eigen::Vector3d(0, -0.03, 0)}) {
      if (azimuth == 180 && push.y() == 0) continue;
      EXPECT_TRUE(sightings(field, "arm", shot(0).T_world_sensor, shot(0, push, 4).view).empty()) << azimuth << " degrees, pushed by " << push.transpose();
    }
  }
}

TEST(ObjectField, AStandingSensorKnowsThatTheObjectMoved) {
  for (const Eigen::Vector3d& push : {Eigen::Vector3d(-0.03, 0, 0), Eigen::Vector3d(0.01, 0, 0), Eigen::Vector3d(0, 0.02, 0)}) {
    const ObjectField field = field_of({0, 180});
    const Shot moved = shot(0, push, 5);
    EXPECT_TRUE(sightings(field, "arm", moved.T_world_sensor, moved.view).empty()) << push.transpose();
    const ObjectField after = remember_view(field, "arm", moved.T_world_sensor, moved.view);
    ASSERT_EQ(after.size(), 1U) << push.transpose();
    EXPECT_NE(after[0].view, field[0].view);
  }
}

}  // namespace
}  // namespace gfp
