#include "registration/align_icp.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gfp/core/mesh.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kCoarsePoints[] = {400, 3000};  ///< Of the source: shares that are settled first.
constexpr double kSettledCoarse = 3e-4, kSettled = 5e-4;  ///< Of the squared error, from one step to the next.

/// The target's points in cubic cells, counting-sorted with x fastest: one row of cells along x is one run in memory.
class PointCells {
 public:
  explicit PointCells(const std::vector<Vector3d>& points) {
    const Bounds box = bounds(points);
    const Vector3d size = box.size();
    // About two points in a cell that the surface passes through.
    const double surface = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
    cell_m_ = std::max({1e-9, std::sqrt(2 * surface / static_cast<double>(points.size())), size.maxCoeff() / 100});
    cells_per_m_ = 1 / cell_m_;
    low_ = box.low;
    for (int axis = 0; axis < 3; ++axis) cells_[static_cast<std::size_t>(axis)] = static_cast<int>(size[axis] / cell_m_) + 1;
    start_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]) + 1, 0);
    const auto cell_of = [&](const Vector3d& p) { return row(along(1, p.y()), along(2, p.z())) + static_cast<std::size_t>(along(0, p.x())); };
    for (const Vector3d& p : points) ++start_[cell_of(p) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
    points_.resize(points.size());
    for (const Vector3d& p : points) points_[static_cast<std::size_t>(next[cell_of(p)]++)] = p;
  }

  const Vector3d& point(std::size_t k) const { return points_[k]; }

  /// The point nearest to `place`, and how much farther than it all others surely are. `guess`: any point; the nearer, the faster.
  struct Nearest {
    std::size_t point = 0;
    double lead_m = 0;
  };
  Nearest nearest(const Vector3d& place, std::size_t guess) const {
    double best = (points_[guess] - place).squaredNorm();
    const double reach = std::sqrt(best) + kLook * cell_m_;  // nothing outside is looked at: it is farther
    double second = reach * reach;
    const int x0 = along(0, place.x() - reach), x1 = along(0, place.x() + reach), y0 = along(1, place.y() - reach), y1 = along(1, place.y() + reach);
    const int z0 = along(2, place.z() - reach), z1 = along(2, place.z() + reach);
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y) {
        const double gap_y = gap(1, y, place.y()), gap_z = gap(2, z, place.z());
        if (gap_y * gap_y + gap_z * gap_z > second) continue;
        const std::size_t cells = row(y, z);
        const auto end = static_cast<std::size_t>(start_[cells + static_cast<std::size_t>(x1) + 1]);
        for (auto k = static_cast<std::size_t>(start_[cells + static_cast<std::size_t>(x0)]); k < end; ++k) {
          const double squared = (points_[k] - place).squaredNorm();
          if (squared < best) {
            second = best;
            best = squared;
            guess = k;
          } else if (squared < second && k != guess) {
            second = squared;
          }
        }
      }
    return {guess, std::sqrt(second) - std::sqrt(best)};
  }

 private:
  int along(int axis, double coordinate) const {
    return static_cast<int>(std::clamp((coordinate - low_[axis]) * cells_per_m_, 0.0, static_cast<double>(cells_[static_cast<std::size_t>(axis)] - 1)));
  }
  std::size_t row(int y, int z) const { return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(cells_[0]); }
  /// From a coordinate to the slab of cells.
  double gap(int axis, int cell, double coordinate) const {
    const double lower = low_[axis] + cell * cell_m_;
    return std::max({0.0, lower - coordinate, coordinate - (lower + cell_m_)});
  }

  static constexpr double kLook = 0.3;  ///< Cells beyond the guess.

  Vector3d low_;
  double cell_m_ = 1, cells_per_m_ = 1;
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<std::int32_t> start_;
  std::vector<Vector3d> points_;
};

/// Sums of pairs, for the best motion between them.
struct PairSums {
  Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();
  Matrix3d product = Matrix3d::Zero();
  double squared = 0, count = 0;
};

/// The motion with the least squared error (Kabsch 1976).
Transform best_motion(const PairSums& sums) {
  const Vector3d from = sums.from / sums.count, to = sums.to / sums.count;
  const Matrix3d covariance = sums.product - sums.count * to * from.transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  Transform motion = Transform::Identity();
  motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  motion.translation() = to - motion.linear() * from;
  return motion;
}

class Alignment {
 public:
  Alignment(const std::vector<Vector3d>& source, const std::vector<Vector3d>& target) : source_(source), cells_(target), found_(source.size()) {}

  IcpResult run(int max_iterations) {
    for (const std::size_t points : kCoarsePoints)
      if (source_.size() >= 2 * points) settle(source_.size() / points, kSettledCoarse, max_iterations);
    result_.mean_squared_m2 = settle(1, kSettled, max_iterations) / static_cast<double>(source_.size());
    return result_;
  }

 private:
  /// Steps until the error settles. A step is drawn out to twice its length and more while that lowers the error (Besl and McKay's acceleration).
  /// Returns the sum of the squared distances.
  double settle(std::size_t step, double share, int max_iterations) {
    Transform& T = result_.T_target_source;
    PairSums now = pair(T, step);
    double drawn = 1;
    result_.converged = false;
    while (result_.iterations < max_iterations) {
      ++result_.iterations;
      const Transform move = best_motion(now) * T.inverse();
      const Transform next = extended(move, drawn) * T;
      PairSums then = pair(next, step);
      if (then.squared <= now.squared) {
        T = next;
        drawn = std::min(kMostDrawn, drawn * 1.5);
      } else {  // the plain step never raises it
        T = move * T;
        then = pair(T, step);
        drawn = 1;
      }
      const bool settled = now.squared - then.squared <= share * now.squared;
      now = then;
      if (settled) {
        result_.converged = true;
        break;
      }
    }
    return now.squared;
  }

  static constexpr double kMostDrawn = 8;

  /// The same screw motion `times` as far.
  static Transform extended(const Transform& move, double times) {
    const Eigen::AngleAxisd turn(move.linear());
    Transform result = Transform::Identity();
    result.linear() = Eigen::AngleAxisd(times * turn.angle(), turn.axis()).toRotationMatrix();
    result.translation() = times * move.translation();
    return result;
  }

  /// Every `step`-th source point, moved, with its nearest target point.
  PairSums pair(const Transform& T, std::size_t step) {
    PairSums sums;
    std::size_t guess = 0;
    for (std::size_t i = 0; i < source_.size(); i += step) {
      const Vector3d moved = T * source_[i];
      Found& found = found_[i];
      // Where it has moved less than half of what the others are farther, its nearest is the nearest still.
      if (4 * (moved - found.at).squaredNorm() >= found.lead_m * found.lead_m) {
        const std::size_t before = (cells_.point(found.point) - moved).squaredNorm() <= (cells_.point(guess) - moved).squaredNorm() ? found.point : guess;
        const auto [point, lead_m] = cells_.nearest(moved, before);
        found = {moved, lead_m, point};
      }
      guess = found.point;
      const Vector3d& hit = cells_.point(guess);
      sums.from += source_[i];
      sums.to += hit;
      sums.product += hit * source_[i].transpose();
      sums.squared += (hit - moved).squaredNorm();
      ++sums.count;
    }
    return sums;
  }

  /// A source point when its nearest was last looked for.
  struct Found {
    Vector3d at = Vector3d::Zero();
    double lead_m = 0;
    std::size_t point = 0;
  };

  const std::vector<Vector3d>& source_;
  PointCells cells_;
  std::vector<Found> found_;
  IcpResult result_;
};

}  // namespace

IcpResult align_icp(const std::vector<Vector3d>& source, const std::vector<Vector3d>& target, int max_iterations) {
  if (source.size() < 3 || target.size() < 3 || max_iterations < 1) return {};
  return Alignment(source, target).run(max_iterations);
}

}  // namespace gfp
