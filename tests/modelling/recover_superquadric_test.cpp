#include "gfp/modelling/recover_superquadric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "modelling/superquadric_residual.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

Superquadric household_superquadric(Random& random) {
  Superquadric s;
  for (int k = 0; k < 3; ++k) s.half_axes_m[k] = random.uniform(0.02, 0.1);
  s.epsilon1 = random.uniform(0.2, 1.4);
  s.epsilon2 = random.uniform(0.2, 1.4);
  s.pose.linear() = rotation_from_vector(Vector3d(random.normal(), random.normal(), random.normal()));
  s.pose.translation() = Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(0.6, 1.2));
  return s;
}

/// Points spread by area over the triangles, with isotropic noise; only those that face `eye` where one is given.
std::vector<Vector3d> sample_surface(const Superquadric& s, int count, double noise_m, Random& random, const Vector3d* eye = nullptr) {
  const TriangleMesh mesh{superquadric_vertices(s), superquadric_topology()->triangles};
  std::vector<double> area{0};
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector3d normal = (b - a).cross(c - a);
    area.push_back(area.back() + (eye && normal.dot(*eye - a) <= 0 ? 0 : normal.norm()));
  }
  std::vector<Vector3d> points;
  while (static_cast<int>(points.size()) < count) {
    const auto at = std::upper_bound(area.begin(), area.end(), random.uniform() * area.back()) - area.begin() - 1;
    const auto& t = mesh.triangles[static_cast<std::size_t>(at)];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    Vector3d p = mesh.vertices[t[0]] + u * (mesh.vertices[t[1]] - mesh.vertices[t[0]]) + v * (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    const Vector3d centre = s.pose.translation();
    p = centre + (p - centre) / gauge(s, p);  // onto the surface itself
    points.push_back(p + noise_m * Vector3d(random.normal(), random.normal(), random.normal()));
  }
  return points;
}

/// Mean distance between two surfaces, over the vertices of the first.
double surface_error(const Superquadric& truth, const Superquadric& fit) {
  double sum = 0;
  const auto vertices = superquadric_vertices(truth);
  for (const auto& v : vertices) sum += std::abs(surface_distance(fit, v)) / static_cast<double>(vertices.size());
  return sum;
}

// Central differences are the oracle of every derivative that the descents use.
TEST(SuperquadricResidual, DerivativesAgreeWithDifferences) {
  Random random(21);
  for (int trial = 0; trial < 50; ++trial) {
    const Superquadric s = household_superquadric(random);
    const Vector3d point = s.pose * Vector3d(s.half_axes_m.cwiseProduct(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))) * 1.4);
    const Vector3d direction = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const auto at = linearised_gauges(s, {&point, 1}).front();
    const auto reaching = linearised_reach(s, direction);
    for (int k = 0; k < kSuperquadricParameters; ++k) {
      const double h = 1e-7;
      const Superquadric more = stepped(s, h * SuperquadricStep::Unit(k), {}), less = stepped(s, -h * SuperquadricStep::Unit(k), {});
      EXPECT_NEAR(at.derivative[k], (gauge(more, point) - gauge(less, point)) / (2 * h), 1e-5 * (1 + std::abs(at.derivative[k]))) << trial << ' ' << k;
      EXPECT_NEAR(reaching.derivative[k], (reach(more, direction) - reach(less, direction)) / (2 * h), 1e-6) << trial << ' ' << k;
    }
    EXPECT_NEAR(reaching.value, reach(s, direction), 1e-12);
  }
}

// Scanning the line finely is the oracle.
TEST(SuperquadricResidual, DeepestPointHasTheSmallestGaugeOfItsLine) {
  Random random(22);
  for (int trial = 0; trial < 100; ++trial) {
    const Superquadric s = household_superquadric(random);
    const Vector3d target = s.pose * Vector3d(1.2 * s.half_axes_m.cwiseProduct(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
    const Ray ray{Vector3d::Zero(), target.normalized()};
    double least = std::numeric_limits<double>::infinity();
    for (double t = 0.2; t < 2; t += 1e-4) least = std::min(least, gauge(s, t * ray.direction));
    EXPECT_LE(gauge(s, deepest_points(s, {&ray, 1}).front()), least * (1 + 2e-3)) << trial;
  }
}

TEST(RecoverSuperquadricEms, FindsBodiesSeenFromAllSides) {
  Random random(23);
  std::vector<double> errors;
  for (int trial = 0; trial < 40; ++trial) {
    const Superquadric truth = household_superquadric(random);
    const auto fit = recover_superquadric_ems(sample_surface(truth, 1000, 0.001, random));
    ASSERT_TRUE(fit.has_value());
    errors.push_back(surface_error(truth, fit->superquadric));
    EXPECT_LT(errors.back(), 0.004) << trial;
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.0004);  // 1 mm of noise averages out over 1000 points
}

TEST(RecoverSuperquadricEms, IgnoresAThirdOfPointsThatBelongToSomethingElse) {
  Random random(24);
  std::vector<double> errors;
  for (int trial = 0; trial < 20; ++trial) {
    const Superquadric truth = household_superquadric(random);
    auto points = sample_surface(truth, 700, 0.001, random);
    for (int k = 0; k < 300; ++k)
      points.push_back(truth.pose.translation() + 0.15 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    const auto fit = recover_superquadric_ems(points, {.outlier_share = 0.3});
    ASSERT_TRUE(fit.has_value());
    errors.push_back(surface_error(truth, fit->superquadric));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.0015);
}

TEST(RecoverSuperquadricLm, FindsBodiesSeenFromAllSides) {
  Random random(25);
  std::vector<double> errors;
  for (int trial = 0; trial < 40; ++trial) {
    const Superquadric truth = household_superquadric(random);
    const auto fit = recover_superquadric_lm(sample_surface(truth, 1000, 0.001, random), {.max_iterations = 60});
    ASSERT_TRUE(fit.has_value());
    errors.push_back(surface_error(truth, fit->superquadric));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.0015);  // it may stop at a look-alike, which EMS leaves
}

TEST(RecoverSuperquadric, MovesWithThePoints) {
  Random random(26);
  for (int trial = 0; trial < 5; ++trial) {
    const auto points = sample_surface(household_superquadric(random), 400, 0.001, random);
    Transform motion = Transform::Identity();
    motion.linear() = rotation_from_vector(Vector3d(random.normal(), random.normal(), random.normal()));
    motion.translation() = Vector3d(0.3, -0.2, 0.5);
    std::vector<Vector3d> moved;
    for (const auto& p : points) moved.push_back(motion * p);
    const auto first = recover_superquadric_ems(points), second = recover_superquadric_ems(moved);
    ASSERT_TRUE(first && second);
    Superquadric expected = first->superquadric;
    expected.pose = motion * expected.pose;
    EXPECT_LT(surface_error(expected, second->superquadric), 2e-4) << trial;
  }
}

TEST(RecoverSuperquadric, SaysWhyItCannot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vector3d> few(11, Vector3d(0, 0, 1)), line, noisy;
  few.emplace_back(nan, 0, 1);
  for (int k = 0; k < 100; ++k) line.emplace_back(0.001 * k, 0.002 * k, 1);
  for (const auto& recover : {recover_superquadric_ems, recover_superquadric_lm}) {
    EXPECT_EQ(recover(few, {}).error().code, ErrorCode::kTooFewPoints);
    EXPECT_EQ(recover({}, {}).error().code, ErrorCode::kTooFewPoints);
    EXPECT_EQ(recover(line, {}).error().code, ErrorCode::kDegenerateGeometry);
  }
}

}  // namespace
}  // namespace gfp
