#include "gfp/grasp/wrench_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "gfp/core/random.hpp"
#include "grasp/qhull_oracle.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(Random& random) { return Vector3d(random.normal(), random.normal(), random.normal()).normalized(); }

/// Contacts on a sphere of radius 5 cm about the origin, normals towards a point near the centre.
std::vector<WrenchContact> random_contacts(Random& random, int count, double torsion_m) {
  std::vector<WrenchContact> contacts;
  const double friction = random.uniform(0.2, 1.0);
  for (int i = 0; i < count; ++i) {
    const Vector3d point = 0.05 * random_direction(random);
    const Vector3d target = 0.01 * random_direction(random);
    contacts.push_back({point, (target - point).normalized(), friction, torsion_m});
  }
  return contacts;
}

/// The second contact opposes the first, as a jaw's do, off the axis and tilted by random amounts.
std::vector<WrenchContact> random_jaw(Random& random, double torsion_m) {
  auto contacts = random_contacts(random, 2, torsion_m);
  contacts[1].point = contacts[0].point + random.uniform(0.02, 0.08) * (contacts[0].normal + 0.15 * random_direction(random)).normalized();
  contacts[1].normal = (-contacts[0].normal + 0.2 * random_direction(random)).normalized();
  return contacts;
}

void expect_equal_to_qhull(const std::vector<WrenchContact>& contacts, const WrenchScale& scale, int cone_edges, const char* what, int seed) {
  const WrenchSpaceOptions options{cone_edges, true};
  const GraspQuality quality = grasp_quality(contacts, scale, options);
  const auto oracle = test::qhull_oracle(primitive_wrenches(contacts, scale, options));
  const double expected = oracle.full ? std::max(0.0, oracle.epsilon) : 0.0;
  EXPECT_NEAR(quality.epsilon, expected, 1e-6) << what << " seed " << seed;
  EXPECT_EQ(quality.force_closure, expected > 1e-9) << what << " seed " << seed;
  EXPECT_NEAR(quality.volume, oracle.volume, 1e-6 * (1 + oracle.volume)) << what << " seed " << seed;
  EXPECT_LE(epsilon_lower_bound(contacts, scale, options), quality.epsilon + 1e-9) << what << " seed " << seed;
}

TEST(GraspQuality, EqualsQhullForTwoSoftContacts) {
  int closed = 0;
  for (int seed = 0; seed < 300; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto contacts = random_jaw(random, random.uniform(0.001, 0.02));
    expect_equal_to_qhull(contacts, {0.01 * random_direction(random), 0.06}, 8, "jaw", seed);
    closed += grasp_quality(contacts, {Vector3d::Zero(), 0.06}).force_closure;
  }
  EXPECT_GT(closed, 100) << "the cases must exercise grasps that close and grasps that do not";
  EXPECT_LT(closed, 290);
}

TEST(GraspQuality, EqualsQhullForThreeToFiveContacts) {
  int closed = 0;
  for (int seed = 0; seed < 150; ++seed) {
    Random random(1000 + static_cast<std::uint64_t>(seed));
    const auto contacts = random_contacts(random, 3 + seed % 3, seed % 2 == 0 ? 0.0 : 0.008);
    expect_equal_to_qhull(contacts, {Vector3d::Zero(), 0.06}, 8, "contacts", seed);
    closed += grasp_quality(contacts, {Vector3d::Zero(), 0.06}).force_closure;
  }
  EXPECT_GT(closed, 30);
  EXPECT_LT(closed, 145);
}

// Symmetric grasps have coplanar wrenches by the dozen, the case in which a hull code that trusts general position fails.
TEST(GraspQuality, EqualsQhullForSymmetricGrasps) {
  for (int count = 2; count <= 6; ++count)
    for (const double torsion_m : {0.0, 0.005})
      for (const int cone_edges : {4, 8}) {
        if (count == 2 && torsion_m == 0) continue;  // flat: below
        std::vector<WrenchContact> ring;
        for (int i = 0; i < count; ++i) {
          const double angle = 2 * std::numbers::pi * i / count;
          const Vector3d outward(std::cos(angle), std::sin(angle), 0);
          ring.push_back({0.04 * outward, -outward, 0.5, torsion_m});
        }
        expect_equal_to_qhull(ring, {Vector3d::Zero(), 0.05}, cone_edges, "ring", 100 * count + cone_edges);
        ring.push_back(ring.front());  // a contact counted twice changes nothing
        expect_equal_to_qhull(ring, {Vector3d::Zero(), 0.05}, cone_edges, "ring with a double", 100 * count + cone_edges);
      }
}

// Opposite contacts at distance R from the centre. With q = mu e / rho the torsional reach and r = mu cos(pi / 8) min(1, R / rho)
// that of the octagon's sides, the nearest facet leans on the torsional pole and one side of each octagon: 1/eps^2 = 1/q^2 + 1/r^2.
TEST(GraspQuality, OfAntipodalPairsOnSphereAndCubeIsClosedForm) {
  for (const double arm : {1.0, 1.0 / std::sqrt(3.0)})  // sphere; face centres of a cube
    for (const double mu : {0.2, 0.5, 1.0})
      for (const double e : {0.002, 0.005}) {
        const double rho = 0.05;
        const Vector3d n = Vector3d(1, 2, -3).normalized();
        const std::vector<WrenchContact> jaw{{-arm * rho * n, n, mu, e}, {arm * rho * n, -n, mu, e}};
        const double q = mu * e / rho, r = mu * std::cos(std::numbers::pi / 8) * arm;
        EXPECT_NEAR(grasp_quality(jaw, {Vector3d::Zero(), rho}).epsilon, 1 / std::sqrt(1 / (q * q) + 1 / (r * r)), 1e-12);
      }
}

// Every subset of six wrenches spans a plane; those with all wrenches on one side are the facets. No hull code involved.
TEST(GraspQuality, EqualsTheEnumerationOfAllPlanes) {
  for (int seed = 0; seed < 4; ++seed) {
    Random random(50 + static_cast<std::uint64_t>(seed));
    const auto contacts = random_contacts(random, 4, 0.0);
    const WrenchSpaceOptions options{3, false};
    const auto wrenches = primitive_wrenches(contacts, {Vector3d::Zero(), 0.06}, options);
    ASSERT_EQ(wrenches.size(), 12U);
    double nearest = 1e300;
    for (unsigned subset = 0; subset < 1U << 12; ++subset) {
      if (__builtin_popcount(subset) != 6) continue;
      Eigen::Matrix<double, 6, 6> rows;
      int row = 0;
      for (int i = 0; i < 12; ++i)
        if (subset >> i & 1U) rows.row(row++) = wrenches[static_cast<std::size_t>(i)].transpose();
      const Wrench normal = rows.fullPivLu().solve(Wrench::Ones());
      if (!normal.allFinite() || (rows * normal - Wrench::Ones()).norm() > 1e-9) continue;
      double support = -1e300;
      for (const Wrench& w : wrenches) support = std::max(support, normal.dot(w));
      if (support < 1 + 1e-9) nearest = std::min(nearest, 1 / normal.norm());
    }
    const auto oracle = test::qhull_oracle(wrenches, false);
    const double expected = oracle.epsilon > 0 ? nearest : 0;
    EXPECT_NEAR(grasp_quality(contacts, {Vector3d::Zero(), 0.06}, options).epsilon, expected, 1e-9) << "seed " << seed;
  }
}

TEST(GraspQuality, IsZeroWhereTheWrenchSpaceIsFlat) {
  const WrenchContact left{{-0.03, 0, 0}, {1, 0, 0}, 0.5, 0}, right{{0.03, 0, 0}, {-1, 0, 0}, 0.5, 0};
  WrenchContact soft = left;
  soft.torsion_m = 0.005;
  const WrenchScale scale{Vector3d::Zero(), 0.05};
  EXPECT_FALSE(grasp_quality({}, scale).force_closure);
  EXPECT_FALSE(grasp_quality(std::vector{soft}, scale).force_closure);
  EXPECT_FALSE(grasp_quality(std::vector{left, right}, scale).force_closure) << "two hard fingers cannot resist torque about their line";
  EXPECT_FALSE(grasp_quality(std::vector{soft, soft}, scale).force_closure) << "two contacts at one place cannot pull back";
  EXPECT_EQ(epsilon_lower_bound(std::vector{left, right}, scale), 0);
  EXPECT_TRUE(grasp_quality(std::vector{soft, right}, scale).force_closure) << "one soft finger is enough";
}

// Friction cones reach 26.6 deg at mu = 0.5: a line of contact inside both closes, outside one it does not (Nguyen 1988).
TEST(GraspQuality, ClosesExactlyWhenTheLineIsInsideBothCones) {
  for (const double degrees : {0.0, 10.0, 23.0, 30.0, 45.0}) {
    const double tilt = degrees * std::numbers::pi / 180;
    const std::vector<WrenchContact> jaw{{{-0.03, 0, 0}, {1, 0, 0}, 0.5, 0.005},
                                         {{0.03, 0, 0}, {-std::cos(tilt), std::sin(tilt), 0}, 0.5, 0.005}};
    EXPECT_EQ(grasp_quality(jaw, {Vector3d::Zero(), 0.05}).force_closure, degrees < 24.0) << degrees;  // octagon: atan(0.5 cos(pi/8)) = 24.8
  }
}

// The bound must be useful as a screen: most closing jaws get a positive one.
TEST(EpsilonLowerBound, IsPositiveForMostJawsThatClose) {
  int closed = 0, bounded = 0;
  for (int seed = 0; seed < 300; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto jaw = random_jaw(random, 0.005);
    closed += grasp_quality(jaw, {jaw[0].point, 0.06}).force_closure;
    bounded += epsilon_lower_bound(jaw, {jaw[0].point, 0.06}) > 0;
  }
  EXPECT_GT(bounded, 0.6 * closed) << bounded << " of " << closed;
}

}  // namespace
}  // namespace gfp
