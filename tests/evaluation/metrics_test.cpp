#include "gfp/evaluation/metrics.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/shapes.hpp"

namespace gfp {
namespace {

constexpr double kRadius = 0.05, kDistance = 0.8;

CameraModel wide_camera() { return default_kinect_camera(); }

TruthView ball_view() {
  auto shape = make_truth_shape("ball", "apple", test::sphere(kRadius, 96, 48));
  EXPECT_TRUE(shape.has_value());
  TruthView view;
  view.shape = std::make_shared<const TruthShape>(std::move(*shape));
  view.T_camera_object.translation() = Eigen::Vector3d(0, 0, kDistance);
  view.visible = visible_samples(*view.shape, view.T_camera_object, wide_camera(), {});
  return view;
}

FittedModel model_of(const TriangleMesh& mesh, const Transform& T_camera_object, double sigma_m) {
  FittedModel fit;
  auto topology = std::make_shared<Topology>();
  topology->triangles = mesh.triangles;
  fit.topology = topology;
  fit.vertices = mesh.vertices;
  fit.T_camera_object = T_camera_object;
  fit.class_name = "apple";
  fit.sigma_m.assign(mesh.vertices.size(), static_cast<float>(sigma_m));
  fit.states.assign(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) fit.states[i] = kVertexObserved;
  return fit;
}

double visible_share(const std::vector<std::uint8_t>& visible) {
  double sum = 0;
  for (const auto v : visible) sum += v;
  return sum / static_cast<double>(visible.size());
}

// From distance d the visible cap of a sphere ends where the tangent touches: its share of the area is (1 - r / d) / 2.
TEST(VisibleSamples, OfASphereAreItsNearCap) {
  const TruthView view = ball_view();
  EXPECT_NEAR(visible_share(view.visible), 0.5 * (1 - kRadius / kDistance), 0.005);
}

TEST(VisibleSamples, AWallHalfAcrossHidesHalfOfThem) {
  const TruthView view = ball_view();
  TriangleMesh wall = test::box({0.2, 0.4, 0.01});
  for (auto& v : wall.vertices) v += Eigen::Vector3d(0.1, 0, 0.4);  // covers x > 0 in the camera frame
  const std::vector<TriangleTree> others{TriangleTree(wall)};
  const auto visible = visible_samples(*view.shape, view.T_camera_object, wide_camera(), others);
  EXPECT_NEAR(visible_share(visible) / visible_share(view.visible), 0.5, 0.01);
}

TEST(VisibleSamples, OutsideTheImageThereAreNone) {
  const TruthView view = ball_view();
  Transform aside = view.T_camera_object;
  aside.translation().x() = 2;
  EXPECT_EQ(visible_share(visible_samples(*view.shape, aside, wide_camera(), {})), 0);
}

TEST(MeasureFit, TheTruthItselfIsPerfect) {
  const TruthView view = ball_view();
  const std::vector<Eigen::Vector3d> points{{0, 0, kDistance - kRadius}};
  const FitMetrics m = measure_fit(view, model_of(view.shape->mesh, view.T_camera_object, 1e-6), points);
  EXPECT_NEAR(m.iou_filled, 1, 1e-4);  // rounding moves a vertex on the lattice into the next voxel
  EXPECT_NEAR(m.iou_material, 1, 1e-4);
  EXPECT_NEAR(m.volume_error, 0, 1e-9);
  EXPECT_NEAR(m.chamfer_m, 0, 1e-12);
  EXPECT_EQ(m.fscore_5mm, 1);
  EXPECT_TRUE(m.closed);
  EXPECT_EQ(m.self_intersections, 0);
  EXPECT_NEAR(m.fit_similarity, m.fit_similarity_true, 1e-12);
  EXPECT_EQ(m.sigma_observed.within, m.sigma_observed.vertices);
}

// Concentric spheres: all distances are the difference of the radii, the volumes' ratio is its cube.
TEST(MeasureFit, ALargerSphereHasTheClosedForms) {
  const TruthView view = ball_view();
  const double larger = 0.054;
  const std::vector<Eigen::Vector3d> points{{0, 0, kDistance - kRadius}, {0, 0, kDistance - larger}};
  const TriangleMesh mesh = test::sphere(larger, 96, 48);
  const FitMetrics m = measure_fit(view, model_of(mesh, view.T_camera_object, 0.003), points);
  const double ratio = std::pow(kRadius / larger, 3);
  EXPECT_NEAR(m.iou_filled, ratio, 0.01);
  EXPECT_NEAR(m.volume_error, 1 / ratio - 1, 0.01);
  EXPECT_NEAR(m.chamfer_m, 0.004, 1e-4);
  EXPECT_NEAR(m.hidden_chamfer_m, 0.004, 1e-4);
  EXPECT_NEAR(m.observed_median_m, 0.004, 1e-4);
  EXPECT_EQ(m.fscore_5mm, 1);
  const double at_4_mm = 1 / (1 + 0.8 * 0.8);
  EXPECT_NEAR(m.fit_similarity, 0.5 * (1 + at_4_mm), 0.005);
  EXPECT_NEAR(m.fit_similarity_true, 0.5 * (1 + at_4_mm), 0.005);
  EXPECT_EQ(m.sigma_observed.within, 0) << "4 mm off with a sigma of 3 mm";
  EXPECT_EQ(measure_fit(view, model_of(mesh, view.T_camera_object, 0.0045), points).sigma_inferred.within, m.sigma_inferred.vertices);
  EXPECT_EQ(m.sigma_observed.vertices + m.sigma_inferred.vertices, static_cast<int>(mesh.vertices.size()));
}

TEST(MeasureFit, OneSidedShiftIsFScoredByBothDirections) {
  const TruthView view = ball_view();
  Transform far = view.T_camera_object;
  far.translation().x() += 0.3;
  const FitMetrics m = measure_fit(view, model_of(view.shape->mesh, far, 0.001), {});
  EXPECT_EQ(m.iou_filled, 0);
  EXPECT_EQ(m.fscore_5mm, 0);
  EXPECT_GT(m.chamfer_m, 0.2);
}

TEST(MeasureFit, YawIsMeasuredModuloTheShapesPeriod) {
  auto shape = make_truth_shape("box_1", "box", test::box({0.1, 0.06, 0.04}));
  ASSERT_TRUE(shape.has_value());
  shape->yaw_period_rad = std::numbers::pi;
  TruthView view;
  view.shape = std::make_shared<const TruthShape>(std::move(*shape));
  view.T_camera_object.translation() = Eigen::Vector3d(0, 0, kDistance);
  view.visible = visible_samples(*view.shape, view.T_camera_object, wide_camera(), {});
  Transform turned = view.T_camera_object;
  turned.rotate(Eigen::AngleAxisd(std::numbers::pi - 0.1, Eigen::Vector3d::UnitZ()));
  FittedModel fit = model_of(view.shape->mesh, turned, 0.001);
  fit.class_name = "box";
  EXPECT_NEAR(measure_fit(view, fit, {}).yaw_error_rad.value(), 0.1, 1e-9);
  fit.class_name = "can";
  EXPECT_FALSE(measure_fit(view, fit, {}).yaw_error_rad.has_value()) << "another class's frame";
}

TEST(MeasureFit, AnEmptyOrBrokenFitIsWorstNotAnError) {
  const TruthView view = ball_view();
  FittedModel fit;
  EXPECT_EQ(measure_fit(view, fit, {}).iou_filled, 0);
  fit = model_of(view.shape->mesh, view.T_camera_object, 0.001);
  fit.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  const FitMetrics m = measure_fit(view, fit, {});
  EXPECT_EQ(m.iou_filled, 0);
  EXPECT_FALSE(m.closed);
  EXPECT_TRUE(std::isinf(m.chamfer_m));
}

TEST(MakeTruthShape, FacesOutwardsAndForgetsInnerShells) {
  TriangleMesh inside_out = test::sphere(0.04, 64, 32);
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  auto turned = make_truth_shape("a", "apple", inside_out);
  ASSERT_TRUE(turned.has_value());
  EXPECT_GT(signed_volume(turned->mesh), 0);

  TriangleMesh nested = test::sphere(0.04, 64, 32);
  append(nested, test::sphere(0.02, 64, 32));
  auto shape = make_truth_shape("b", "apple", nested);
  ASSERT_TRUE(shape.has_value());
  for (const auto& p : shape->samples.points) EXPECT_GT(p.norm(), 0.035);
}

TEST(MakeTruthShape, RefusesAFlatMesh) {
  EXPECT_EQ(make_truth_shape("flat", "plate", {{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}}, {{0, 1, 2}}}).error().code, ErrorCode::kDegenerateGeometry);
}

}  // namespace
}  // namespace gfp
