#include "gfp/core/transform.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

TEST(RotationVector, RoundTrips) {
  Random random(7);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d omega = Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized() * random.uniform(0, 3.1);
    EXPECT_TRUE(rotation_vector(rotation_from_vector(omega)).isApprox(omega, 1e-9)) << omega.transpose();
  }
  EXPECT_TRUE(rotation_from_vector(Eigen::Vector3d::Zero()).isIdentity());
}

TEST(OrthonormalBasis, IsRightHandedEverywhere) {
  Random random(8);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d axis = k == 0 ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const auto [first, second] = orthonormal_basis(axis);
    EXPECT_TRUE(first.cross(second).isApprox(axis, 1e-12));
    EXPECT_NEAR(first.dot(axis), 0, 1e-12);
  }
}

}  // namespace
}  // namespace gfp
