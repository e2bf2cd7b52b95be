#include "gfp/core/residual_rows.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

// J^T W J and J^T W r as Eigen forms them, for numbers of unknowns on both sides of the block size.
TEST(ResidualRows, SumsTheNormalEquations) {
  Random random(5);
  for (const int unknowns : {1, 3, 4, 7, 11, 16, 17}) {
    constexpr int kRows = 50;
    Eigen::MatrixXd jacobian(kRows, unknowns);
    Eigen::VectorXd residuals(kRows), weights(kRows);
    ResidualRows rows;
    rows.reset(99);
    rows.add(7);
    rows.reset(unknowns);
    for (int k = 0; k < kRows; ++k) {
      residuals[k] = random.normal();
      weights[k] = random.uniform(0, 2);
      const auto row = rows.add(residuals[k]);
      for (int j = 0; j < unknowns; ++j) row[static_cast<std::size_t>(j)] = jacobian(k, j) = random.normal();
    }
    ASSERT_EQ(rows.size(), kRows);
    EXPECT_EQ(rows.residual(3), residuals[3]);
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    rows.normal_equations({weights.data(), kRows}, information, gradient);
    EXPECT_TRUE(information.isApprox(jacobian.transpose() * weights.asDiagonal() * jacobian, 1e-13)) << unknowns;
    EXPECT_TRUE(gradient.isApprox(jacobian.transpose() * weights.asDiagonal() * residuals, 1e-13)) << unknowns;
  }
}

TEST(ResidualRows, NoRowsGiveZeros) {
  ResidualRows rows;
  rows.reset(5);
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  rows.normal_equations({}, information, gradient);
  EXPECT_TRUE(information.isZero() && information.rows() == 5);
  EXPECT_TRUE(gradient.isZero() && gradient.size() == 5);
}

}  // namespace
}  // namespace gfp
