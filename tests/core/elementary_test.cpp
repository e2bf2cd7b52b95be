#include "gfp/core/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

double relative_error(double found, double expected) { return std::abs(found - expected) / std::max(std::abs(expected), std::numeric_limits<double>::min()); }

TEST(Elementary, LogarithmAgreesWithTheCLibrary) {
  Random random(1);
  double worst = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double x = std::exp(random.uniform(-700, 700));
    worst = std::max(worst, relative_error(fast_log(x), std::log(x)));
    const double near_one = 1 + random.uniform(-0.5, 0.5);
    worst = std::max(worst, relative_error(fast_log(near_one), std::log(near_one)));
  }
  EXPECT_LT(worst, 4.5e-16);
  EXPECT_EQ(fast_log(1.0), 0.0);
}

TEST(Elementary, ExponentialAgreesWithTheCLibrary) {
  Random random(2);
  double worst = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double x = random.uniform(-707, 708);
    worst = std::max(worst, relative_error(fast_exp(x), std::exp(x)));
  }
  EXPECT_LT(worst, 4.5e-16);
  EXPECT_EQ(fast_exp(0.0), 1.0);
  EXPECT_EQ(fast_exp(-1e300), fast_exp(-708));
  EXPECT_EQ(fast_exp(1e300), fast_exp(709));
}

TEST(Elementary, AngleAgreesWithTheCLibrary) {
  Random random(3);
  double worst = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double sine = std::abs(random.normal()), cosine = random.normal(), length = std::exp(random.uniform(-30, 30));
    worst = std::max(worst, std::abs(fast_angle(length * sine, length * cosine) - std::atan2(sine, cosine)));
  }
  EXPECT_LT(worst, 3e-8);
  EXPECT_EQ(fast_angle(0, 0), 0);
  EXPECT_EQ(fast_angle(0, 2), 0);
  EXPECT_DOUBLE_EQ(fast_angle(0, -1), 3.141592653589793);
  EXPECT_DOUBLE_EQ(fast_angle(4, 0), 3.141592653589793 / 2);
  EXPECT_DOUBLE_EQ(fast_angle(1, 1), 3.141592653589793 / 4);
}

}  // namespace
}  // namespace gfp
