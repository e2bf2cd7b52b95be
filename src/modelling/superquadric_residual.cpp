#include "modelling/superquadric_residual.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "modelling/superquadric_norm.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A superquadric as loops over many points want it; rotation row by row, frame to body.
struct Body {
  double rotation[9], centre[3], per_half_axis[3], p1, p2;

  explicit Body(const Superquadric& s) : p1(2 / s.epsilon1), p2(2 / s.epsilon2) {
    const Eigen::Matrix3d turn = s.pose.linear();  // its columns are the rows of its inverse
    std::copy_n(turn.data(), 9, rotation);
    for (int k = 0; k < 3; ++k) {
      centre[k] = s.pose.translation()[k];
      per_half_axis[k] = 1 / s.half_axes_m[k];
    }
  }
};

/// Of one point: body coordinates, gauge, its gradient there (body) and its derivatives by the two norms' exponents.
struct GaugeInBody {
  double body[3], gradient[3], value, by_p1, by_p2;
};

inline __attribute__((always_inline)) GaugeInBody gauge_in_body(const Body& s, double x, double y, double z) {
  GaugeInBody g;
  double unit[3];
  for (int k = 0; k < 3; ++k) {
    g.body[k] = s.rotation[3 * k] * (x - s.centre[0]) + s.rotation[3 * k + 1] * (y - s.centre[1]) + s.rotation[3 * k + 2] * (z - s.centre[2]);
    unit[k] = g.body[k] * s.per_half_axis[k];
  }
  const NestedNorm norm = nested_norm(unit[0], unit[1], unit[2], s.p1, s.p2);
  for (int k = 0; k < 3; ++k) g.gradient[k] = norm.slope[k] * s.per_half_axis[k];
  g.value = norm.value;
  g.by_p1 = norm.by_p1;
  g.by_p2 = norm.by_p2;
  return g;
}

/// `points`: x y z of each in turn.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void gauges(const Body& body, const double* __restrict points, std::size_t count,
                                                                        GaugeInBody* __restrict out) {
  const Body s = body;
  for (std::size_t k = 0; k < count; ++k) out[k] = gauge_in_body(s, points[3 * k], points[3 * k + 1], points[3 * k + 2]);
}

/// Many lines in body coordinates divided by the half axes, where the body is a unit ball of the nested norms: coordinate by coordinate.
struct Lines {
  std::vector<double> origin[3], direction[3];
  std::vector<double> low, high, slope_low, slope_high;  ///< Brackets of the parameter with the least gauge, and the gauge's slopes there.

  explicit Lines(std::size_t count) : low(count), high(count), slope_low(count), slope_high(count) {
    for (auto* axis : {&origin[0], &origin[1], &origin[2], &direction[0], &direction[1], &direction[2]}) axis->resize(count);
  }
};

constexpr int kLineSteps = 12;  ///< Of which every second halves the bracket.

/// Slopes of the gauge along the lines at parameters `t`.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void slopes_along(double p1, double p2, const double* __restrict ox, const double* __restrict oy,
                                                                              const double* __restrict oz, const double* __restrict dx, const double* __restrict dy,
                                                                              const double* __restrict dz, const double* __restrict t, std::size_t count,
                                                                              double* __restrict slope) {
  for (std::size_t k = 0; k < count; ++k) {
    const double x = ox[k] + t[k] * dx[k], y = oy[k] + t[k] * dy[k], z = oz[k] + t[k] * dz[k];
    const PNorm across = p_norm(std::abs(x), std::abs(y), p2);
    const PNorm whole = p_norm(across.value, std::abs(z), p1);
    slope[k] = whole.by_a * (std::copysign(across.by_a, x) * dx[k] + std::copysign(across.by_b, y) * dy[k]) + std::copysign(whole.by_b, z) * dz[k];
  }
}

/// Narrows all brackets in step. The gauge is convex, so its slope along a line changes sign once. Secant steps crawl where a sharp edge
/// makes the slope jump: they alternate with halving.
void narrow(const Superquadric& s, Lines& lines) {
  const std::size_t count = lines.low.size();
  const auto slopes = [&](const std::vector<double>& t, std::vector<double>& slope) {
    slopes_along(2 / s.epsilon1, 2 / s.epsilon2, lines.origin[0].data(), lines.origin[1].data(), lines.origin[2].data(), lines.direction[0].data(),
                 lines.direction[1].data(), lines.direction[2].data(), t.data(), count, slope.data());
  };
  slopes(lines.low, lines.slope_low);
  slopes(lines.high, lines.slope_high);
  std::vector<double> t(count), here(count);
  for (int step = 0; step < kLineSteps; ++step) {
    for (std::size_t k = 0; k < count; ++k) {
      const double secant = -lines.slope_low[k] / std::max(lines.slope_high[k] - lines.slope_low[k], 1e-300);
      t[k] = lines.low[k] + (lines.high[k] - lines.low[k]) * (step % 2 == 0 ? std::clamp(secant, 0.0, 1.0) : 0.5);
    }
    slopes(t, here);
    for (std::size_t k = 0; k < count; ++k) {
      (here[k] < 0 ? lines.low : lines.high)[k] = t[k];
      (here[k] < 0 ? lines.slope_low : lines.slope_high)[k] = here[k];
    }
  }
}

}  // namespace

Superquadric stepped(const Superquadric& superquadric, const SuperquadricStep& step, const SuperquadricLimits& limits) {
  Superquadric s = superquadric;
  s.pose.translation() += step.segment<3>(kTranslation);
  s.pose.linear() = s.pose.linear() * rotation_from_vector(step.segment<3>(kRotation));
  for (int k = 0; k < 3; ++k) {
    const double factor = std::exp(std::clamp(step[kLogAxes + k], -0.7, 0.7));  // at most doubled in one step
    s.half_axes_m[k] = std::clamp(s.half_axes_m[k] * factor, limits.min_half_axis_m, limits.max_half_axis_m);
  }
  s.epsilon1 = std::clamp(s.epsilon1 + step[kEpsilon1], limits.min_epsilon, limits.max_epsilon);
  s.epsilon2 = std::clamp(s.epsilon2 + step[kEpsilon2], limits.min_epsilon, limits.max_epsilon);
  return s;
}

std::vector<LinearisedGauge> linearised_gauges(const Superquadric& s, std::span<const Vector3d> points) {
  std::vector<GaugeInBody> found(points.size());
  if (!points.empty()) gauges(Body(s), points.front().data(), points.size(), found.data());
  std::vector<LinearisedGauge> result(points.size());
  const Eigen::Matrix3d rotation = s.pose.linear();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector3d gradient(found[k].gradient[0], found[k].gradient[1], found[k].gradient[2]), body(found[k].body[0], found[k].body[1], found[k].body[2]);
    LinearisedGauge& gauge = result[k];
    gauge.value = found[k].value;
    gauge.slope = gradient.norm();
    gauge.derivative.segment<3>(kTranslation) = -(rotation * gradient);
    gauge.derivative.segment<3>(kRotation) = gradient.cross(body);
    gauge.derivative.segment<3>(kLogAxes) = -gradient.cwiseProduct(body);
    gauge.derivative[kEpsilon1] = found[k].by_p1 * (-2 / (s.epsilon1 * s.epsilon1));
    gauge.derivative[kEpsilon2] = found[k].by_p2 * (-2 / (s.epsilon2 * s.epsilon2));
  }
  return result;
}

LinearisedLength linearised_reach(const Superquadric& s, const Vector3d& direction) {
  const Vector3d body = s.pose.linear().transpose() * direction;
  const Vector3d scaled = body.cwiseProduct(s.half_axes_m);
  const double q1 = 2 / (2 - s.epsilon1), q2 = 2 / (2 - s.epsilon2);  // dual exponents; epsilon < 2 by the limits
  const NestedNorm norm = nested_norm(scaled.x(), scaled.y(), scaled.z(), q1, q2);
  const Vector3d by_scaled(norm.slope[0], norm.slope[1], norm.slope[2]);
  LinearisedLength length;
  length.value = norm.value;
  length.derivative.segment<3>(kRotation) = by_scaled.cwiseProduct(s.half_axes_m).cross(body);
  length.derivative.segment<3>(kLogAxes) = by_scaled.cwiseProduct(scaled);
  length.derivative[kEpsilon1] = norm.by_p1 * 0.5 * q1 * q1;
  length.derivative[kEpsilon2] = norm.by_p2 * 0.5 * q2 * q2;
  return length;
}

std::vector<Vector3d> deepest_points(const Superquadric& s, std::span<const Ray> rays) {
  Lines lines(rays.size());
  const Eigen::Matrix3d to_unit = s.half_axes_m.cwiseInverse().asDiagonal() * s.pose.linear().transpose();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Vector3d to_centre = s.pose.translation() - rays[k].origin, origin = -(to_unit * to_centre), direction = to_unit * rays[k].direction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lines.origin[axis][k] = origin[static_cast<Eigen::Index>(axis)];
      lines.direction[axis][k] = direction[static_cast<Eigen::Index>(axis)];
    }
    const double nearest = rays[k].direction.dot(to_centre), beside = std::sqrt(std::max(0.0, to_centre.squaredNorm() - nearest * nearest));
    const double reach_m = s.half_axes_m.norm() + 2 * beside;
    lines.low[k] = nearest - reach_m;
    lines.high[k] = nearest + reach_m;
  }
  narrow(s, lines);
  std::vector<Vector3d> points(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) points[k] = rays[k].origin + 0.5 * (lines.low[k] + lines.high[k]) * rays[k].direction;
  return points;
}

}  // namespace gfp
