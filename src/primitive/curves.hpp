#pragma once

#include <Eigen/Core>
#include <vector>

namespace gfp {

/// `count` unit vectors counter-clockwise from +x, exactly mirrored in both axes (count even).
std::vector<Eigen::Vector2d> unit_circle(int count);

/// As unit_circle, but the columns beside column 0 stand `half_angle_rad` from it and the rest share what is left:
/// a handle's root is as wide as the handle. Mirrored in the x axis exactly.
std::vector<Eigen::Vector2d> circle_with_root(int count, double half_angle_rad);

/// Superellipse |x|^n + |y|^n = 1 in the direction of a unit vector; n = 2 is the circle, larger n squarer.
Eigen::Vector2d superellipse(const Eigen::Vector2d& direction, double n);

/// Catmull-Rom spline through (knots, values), knots ascending, linear in the values; constant beyond the ends.
class Spline {
 public:
  Spline(std::vector<double> knots, std::vector<double> values) : knots_(std::move(knots)), values_(std::move(values)) {}
  double operator()(double at) const;

 private:
  double slope(std::size_t knot) const;
  std::vector<double> knots_, values_;
};

/// `count` points at equal arc length along a polyline, ends included.
std::vector<Eigen::Vector2d> resample(const std::vector<Eigen::Vector2d>& line, int count);

inline double mix(double a, double b, double t) { return a + (b - a) * t; }
/// 0 below `low`, 1 above `high`, with zero slope at both.
double smooth_step(double low, double high, double at);

}  // namespace gfp
