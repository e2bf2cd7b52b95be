#include "primitive/curves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gfp {

std::vector<Eigen::Vector2d> unit_circle(int count) {
  std::vector<Eigen::Vector2d> directions;
  for (int k = 0; k < count; ++k) {
    const int folded = std::min(k, count - k);  // mirror in the x axis, then in the y axis: exact pairs
    const bool left = 4 * folded > count;
    const int quarter = left ? count / 2 - folded : folded;
    const double angle = 2.0 * std::numbers::pi * quarter / count;
    const double x = 4 * quarter == count ? 0.0 : std::cos(angle), y = std::sin(angle);
    directions.emplace_back(left ? -x : x, 2 * k > count ? -y : y);
  }
  return directions;
}

std::vector<Eigen::Vector2d> circle_with_root(int count, double half_angle_rad) {
  std::vector<Eigen::Vector2d> directions(static_cast<std::size_t>(count));
  directions[0] = {1, 0};
  const int half = count / 2;
  directions[static_cast<std::size_t>(half)] = {-1, 0};
  for (int k = 1; k < half; ++k) {
    const double angle = half_angle_rad + (std::numbers::pi - half_angle_rad) * (k - 1) / (half - 1);
    directions[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
    directions[static_cast<std::size_t>(count - k)] = {std::cos(angle), -std::sin(angle)};
  }
  return directions;
}

Eigen::Vector2d superellipse(const Eigen::Vector2d& direction, double n) {
  return direction / std::pow(std::pow(std::abs(direction.x()), n) + std::pow(std::abs(direction.y()), n), 1.0 / n);
}

double Spline::slope(std::size_t knot) const {
  const std::size_t before = knot == 0 ? 0 : knot - 1, after = std::min(knot + 1, knots_.size() - 1);
  return (values_[after] - values_[before]) / (knots_[after] - knots_[before]);
}

double Spline::operator()(double at) const {
  if (at <= knots_.front()) return values_.front();
  if (at >= knots_.back()) return values_.back();
  const auto right = static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), at) - knots_.begin());
  const std::size_t left = right - 1;
  const double length = knots_[right] - knots_[left], t = (at - knots_[left]) / length;
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * values_[left] + (t3 - 2 * t2 + t) * length * slope(left) +
         (3 * t2 - 2 * t3) * values_[right] + (t3 - t2) * length * slope(right);
}

std::vector<Eigen::Vector2d> resample(const std::vector<Eigen::Vector2d>& line, int count) {
  std::vector<double> along(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) along[i] = along[i - 1] + (line[i] - line[i - 1]).norm();
  std::vector<Eigen::Vector2d> points;
  std::size_t right = 1;
  for (int i = 0; i < count; ++i) {
    const double at = along.back() * i / (count - 1);
    while (right + 1 < line.size() && along[right] < at) ++right;
    const double t = (at - along[right - 1]) / (along[right] - along[right - 1]);
    points.push_back(line[right - 1] + (line[right] - line[right - 1]) * std::clamp(t, 0.0, 1.0));
  }
  return points;
}

double smooth_step(double low, double high, double at) {
  const double t = std::clamp((at - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace gfp
