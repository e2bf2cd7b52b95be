#include "modelling/superquadric_em.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/elementary.hpp"
#include "gfp/core/residual_rows.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Information = Eigen::Matrix<double, kSuperquadricParameters, kSuperquadricParameters>;
using Basis = Eigen::Matrix<double, kSuperquadricParameters, Eigen::Dynamic, 0, kSuperquadricParameters, kSuperquadricParameters>;

constexpr double kSpillLinear = 3.0;         ///< Sigmas from which a spill's cost grows linearly.
constexpr double kAspectSigma = 1.0;         ///< Prior of log(a_i / a_j): decides only where the data do not.
constexpr double kEpsilonMean = 0.7, kEpsilonSigma = 0.7;  ///< Household things: between boxes and ellipsoids.

/// Distances from the surface (first-order, as surface_distance()) of all points, then of all tangents, each a row with its derivative by a
/// step; the normalisation by the gauge's slope is held fixed in the derivative (Gauss-Newton).
using Lengths = ResidualRows;

Superquadric on_base(Superquadric s) {
  s.pose.translation().z() = reach(s, -Vector3d::UnitZ());
  return s;
}

void add_distances(const Superquadric& s, std::span<const Vector3d> points, Lengths& lengths) {
  for (const LinearisedGauge& at : linearised_gauges(s, points)) {
    const std::span<double> row = lengths.add((at.value - 1) / at.slope);
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = at.derivative[static_cast<Eigen::Index>(k)] / at.slope;
  }
}

void linearise(const SuperquadricData& problem, const Superquadric& s, Lengths& lengths) {
  lengths.reset(kSuperquadricParameters);
  add_distances(s, problem.points, lengths);
  // By the envelope theorem the touching point may be held fixed along its ray while the parameters move.
  add_distances(s, deepest_points(s, problem.tangents), lengths);
}

/// Columns: what a free parameter does to the full step. A body on its base rises with its reach downwards.
Basis free_directions(const SuperquadricData& problem, const Superquadric& s, const SuperquadricFreedom& freedom) {
  Basis basis(kSuperquadricParameters, 0);
  const auto add = [&](const SuperquadricStep& column) {
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.col(basis.cols() - 1) = column;
  };
  const auto unit = [](int index) { return SuperquadricStep(SuperquadricStep::Unit(index)); };
  add(unit(kTranslation));
  add(unit(kTranslation + 1));
  if (!problem.on_base) add(unit(kTranslation + 2));
  if (freedom.rotation == SuperquadricFreedom::Rotation::kFree) {
    for (int k = 0; k < 3; ++k) add(unit(kRotation + k));
  } else {
    SuperquadricStep turn = SuperquadricStep::Zero();
    turn.segment<3>(kRotation) = s.pose.linear().row(2).transpose();
    add(turn);
  }
  using Axes = SuperquadricFreedom::Axes;
  if (freedom.axes == Axes::kFree) {
    for (int k = 0; k < 3; ++k) add(unit(kLogAxes + k));
  } else if (freedom.axes == Axes::kRound) {
    add(unit(kLogAxes) + unit(kLogAxes + 1));
    add(unit(kLogAxes + 2));
  } else {
    add(unit(kLogAxes) + unit(kLogAxes + 1) + unit(kLogAxes + 2));
  }
  if (freedom.epsilon1) add(unit(kEpsilon1));
  if (freedom.epsilon2) add(unit(kEpsilon2));
  if (problem.on_base) basis.row(kTranslation + 2) += linearised_reach(s, -Vector3d::UnitZ()).derivative.transpose() * basis;
  return basis;
}

double gaussian(double value, double sigma) {
  return fast_exp(-0.5 * value * value / (sigma * sigma)) / (sigma * std::sqrt(2 * std::numbers::pi));
}

/// Widths of the Gaussian parts: points and tangents err for different reasons, so each has its own.
struct Widths {
  double points = 0, tangents = 0;
};

class Mixture {
 public:
  Mixture(const SuperquadricData& problem, const EmOptions& options) : problem_(problem), options_(options) {
    const auto points = static_cast<double>(problem.points.size()), tangents = static_cast<double>(problem.tangents.size());
    if (tangents > 0) tangent_weight_ = std::min(4.0, options.tangent_weight * points / tangents);
  }

  Widths start(const Lengths& lengths) const {
    const std::size_t middle = problem_.points.size();
    return {median_width(lengths, 0, middle, problem_.sigma_m), median_width(lengths, middle, lengths.size(), problem_.tangent_sigma_m)};
  }

  /// E-step: the probability that each length belongs to the surface, times its weight and divided by its variance.
  void weigh(const Lengths& lengths, const Widths& widths, std::vector<double>& weights) const {
    weights.resize(lengths.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (spills(i, lengths.residual(i))) {
        const double sigma = problem_.tangent_sigma_m;
        weights[i] = weight_of(i) * std::min(1.0, kSpillLinear * sigma / -lengths.residual(i)) / (sigma * sigma);
        continue;
      }
      const double width = is_point(i) ? widths.points : widths.tangents;
      const double on = (1 - options_.outlier_share) * gaussian(lengths.residual(i), width);
      weights[i] = weight_of(i) * on / (on + options_.outlier_share / problem_.range_m) / (width * width);
    }
  }

  Widths updated(const Lengths& lengths, const Widths& widths, const std::vector<double>& weights) const {
    Widths squares, total;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (spills(i, lengths.residual(i))) continue;
      (is_point(i) ? squares.points : squares.tangents) += weights[i] * lengths.residual(i) * lengths.residual(i);
      (is_point(i) ? total.points : total.tangents) += weights[i];
    }
    const auto width = [&](double square, double sum, double floor, double before) {
      return sum > 0 ? std::clamp(std::sqrt(square / sum), floor, problem_.range_m) : before;
    };
    return {width(squares.points, total.points, problem_.sigma_m, widths.points),
            width(squares.tangents, total.tangents, problem_.tangent_sigma_m, widths.tangents)};
  }

  double negative_log_likelihood(const Lengths& lengths, const Widths& widths) const {
    double sum = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (spills(i, lengths.residual(i))) {
        const double excess = -lengths.residual(i) / problem_.tangent_sigma_m, bend = kSpillLinear;
        const double huber = excess < bend ? 0.5 * excess * excess : bend * (excess - 0.5 * bend);
        sum += weight_of(i) * (huber - fast_log(gaussian(0, problem_.tangent_sigma_m)));
        continue;
      }
      sum -= weight_of(i) * fast_log((1 - options_.outlier_share) * gaussian(lengths.residual(i), is_point(i) ? widths.points : widths.tangents) +
                                     options_.outlier_share / problem_.range_m);
    }
    return sum;
  }

 private:
  /// Does the body reach into a line of sight that was seen to be free? No outlier explains that away, whereas a line that the
  /// body does not reach may belong to a handle.
  bool spills(std::size_t i, double length) const { return !is_point(i) && length < 0; }
  double median_width(const Lengths& lengths, std::size_t first, std::size_t last, double floor) const {
    if (first == last) return floor;
    std::vector<double> sizes;
    for (; first != last; ++first) sizes.push_back(std::abs(lengths.residual(first)));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return std::clamp(1.4826 * *middle, floor, problem_.range_m);
  }
  bool is_point(std::size_t i) const { return i < problem_.points.size(); }
  double weight_of(std::size_t i) const { return options_.independence * (is_point(i) ? 1.0 : tangent_weight_); }

  const SuperquadricData& problem_;
  const EmOptions& options_;
  double tangent_weight_ = 1;
};

/// Weak beliefs that keep every system regular: sides of like length, exponents of household things.
struct Prior {
  double value = 0;
  SuperquadricStep gradient = SuperquadricStep::Zero();
  Information hessian = Information::Zero();
};

Prior prior_of(const Superquadric& s) {
  Prior prior;
  const double aspect = 1 / (kAspectSigma * kAspectSigma), shape = 1 / (kEpsilonSigma * kEpsilonSigma);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double difference = std::log(s.half_axes_m[i] / s.half_axes_m[j]);
      prior.value += 0.5 * aspect * difference * difference;
      prior.gradient[kLogAxes + i] += aspect * difference;
      prior.gradient[kLogAxes + j] -= aspect * difference;
      prior.hessian(kLogAxes + i, kLogAxes + i) += aspect;
      prior.hessian(kLogAxes + j, kLogAxes + j) += aspect;
      prior.hessian(kLogAxes + i, kLogAxes + j) -= aspect;
      prior.hessian(kLogAxes + j, kLogAxes + i) -= aspect;
    }
  for (const auto& [index, epsilon] : {std::pair(kEpsilon1, s.epsilon1), {kEpsilon2, s.epsilon2}}) {
    prior.value += 0.5 * shape * (epsilon - kEpsilonMean) * (epsilon - kEpsilonMean);
    prior.gradient[index] += shape * (epsilon - kEpsilonMean);
    prior.hessian(index, index) += shape;
  }
  return prior;
}

double surrogate(const Lengths& lengths, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) sum += 0.5 * weights[i] * lengths.residual(i) * lengths.residual(i);
  return sum;
}

struct NormalEquations {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

NormalEquations normal_equations(const Superquadric& s, const Lengths& lengths, const std::vector<double>& weights, const Prior& prior,
                                 const SuperquadricLimits& limits) {
  NormalEquations system;
  lengths.normal_equations(weights, system.hessian, system.gradient);
  system.hessian += prior.hessian;
  system.gradient += prior.gradient;
  // An exponent at its limit that is pushed outwards does not take part.
  for (const auto& [index, epsilon] : {std::pair<int, double>(kEpsilon1, s.epsilon1), {kEpsilon2, s.epsilon2}}) {
    const bool held = (epsilon <= limits.min_epsilon && system.gradient[index] > 0) || (epsilon >= limits.max_epsilon && system.gradient[index] < 0);
    if (!held) continue;
    system.hessian.row(index).setZero();
    system.hessian.col(index).setZero();
    system.hessian(index, index) = 1;
    system.gradient[index] = 0;
  }
  return system;
}

template <class T>
std::vector<T> evenly(const std::vector<T>& all, std::size_t count) {
  if (all.size() <= count) return all;
  std::vector<T> some;
  for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
  return some;
}

}  // namespace

SuperquadricData thinned(const SuperquadricData& problem, std::size_t points, std::size_t tangents) {
  SuperquadricData some = problem;
  some.points = evenly(problem.points, points);
  some.tangents = evenly(problem.tangents, tangents);
  return some;
}

EmFit maximise(const SuperquadricData& problem, const Superquadric& start, const SuperquadricFreedom& freedom, const EmOptions& options) {
  const Mixture mixture(problem, options);
  EmFit fit;
  fit.superquadric = problem.on_base ? on_base(start) : start;
  Lengths lengths, trial_lengths;
  std::vector<double> weights;
  linearise(problem, fit.superquadric, lengths);
  Widths widths = mixture.start(lengths);
  Prior prior = prior_of(fit.superquadric);
  double damping = 1e-2;
  for (; fit.iterations < options.max_iterations && !fit.converged; ++fit.iterations) {
    mixture.weigh(lengths, widths, weights);
    const auto system = normal_equations(fit.superquadric, lengths, weights, prior, problem.limits);
    const Basis basis = free_directions(problem, fit.superquadric, freedom);
    const Eigen::MatrixXd reduced = basis.transpose() * system.hessian * basis;
    Eigen::MatrixXd damped = reduced;
    damped.diagonal() += damping * (reduced.diagonal().array() + 1e-9).matrix();
    const SuperquadricStep step = -(basis * damped.ldlt().solve(basis.transpose() * system.gradient));
    Superquadric trial = stepped(fit.superquadric, step, problem.limits);
    if (problem.on_base) trial = on_base(trial);
    linearise(problem, trial, trial_lengths);
    const Prior trial_prior = prior_of(trial);
    const double before = surrogate(lengths, weights) + prior.value, after = surrogate(trial_lengths, weights) + trial_prior.value;
    fit.information = system.hessian;
    if (!(after < before)) {
      fit.converged = damping > 1e3 || (step.transpose() * system.hessian * step).value() < 1e-6 * before;
      damping *= 8;
      continue;
    }
    damping = std::max(1e-6, damping / 5);
    fit.superquadric = trial;
    std::swap(lengths, trial_lengths);
    prior = trial_prior;
    const Widths widths_before = widths;
    widths = mixture.updated(lengths, widths, weights);
    const auto settled = [](double now, double then) { return std::abs(now - then) < 5e-3 * then; };
    fit.converged = before - after < 1e-4 * before && settled(widths.points, widths_before.points) && settled(widths.tangents, widths_before.tangents);
  }
  fit.sigma_m = widths.points;
  fit.objective = mixture.negative_log_likelihood(lengths, widths) + prior.value;
  return fit;
}

std::vector<Superquadric> similar_shapes(const Superquadric& s) {
  std::vector<Superquadric> shapes;
  const auto turned = [&](const Eigen::Matrix3d& R_body_new) {
    Superquadric other = s;
    other.pose.linear() = s.pose.linear() * R_body_new;
    return other;
  };
  // The other two axes become the z axis (cyclic, so the frame stays right-handed). Along the new z runs an old cross-section.
  for (int shift = 1; shift <= 2; ++shift) {
    Eigen::Matrix3d permutation = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) permutation((k + shift) % 3, k) = 1;
    Superquadric other = turned(permutation);
    for (int k = 0; k < 3; ++k) other.half_axes_m[k] = s.half_axes_m[(k + shift) % 3];
    other.epsilon1 = s.epsilon2;
    other.epsilon2 = s.epsilon1;
    shapes.push_back(other);
  }
  // A square turned by 45 degrees is a diamond: its new axes are the old diagonals.
  const double ratio = s.half_axes_m.x() / s.half_axes_m.y();
  if (ratio > 0.6 && ratio < 1.0 / 0.6) {
    const double mean = std::sqrt(s.half_axes_m.x() * s.half_axes_m.y());
    const double diagonal = std::pow(2.0, 0.5 - 0.5 * s.epsilon2);  // radius there: (1/2)^(epsilon2/2) sqrt(2)
    Superquadric other = turned(Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ()).toRotationMatrix());
    other.half_axes_m.x() = other.half_axes_m.y() = mean * diagonal;
    other.epsilon2 = std::clamp(2 - s.epsilon2, 0.1, 1.9);
    shapes.push_back(other);
  }
  return shapes;
}

}  // namespace gfp
