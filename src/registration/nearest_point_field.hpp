#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace gfp {

/// The nearest of a few thousand points, looked up in a grid around them: made once, then a few nanoseconds a query.
///
/// Every cell holds the point nearest to its middle, carried from cell to cell (two sweeps); a query's answer is that point's exact
/// distance, at most a cell's diagonal more than the nearest point's. Outside the grid its border answers.
class NearestPointField {
 public:
  /// @param points  at least one, metres. @param margin_m  how far the grid reaches beyond them.
  NearestPointField(std::vector<Eigen::Vector3d> points, double margin_m);

  double distance(const Eigen::Vector3d& place) const { return (points_[nearest(place)] - place).norm(); }
  std::size_t nearest(const Eigen::Vector3d& place) const;

 private:
  static constexpr int kSide = 40;
  std::size_t cell(int x, int y, int z) const { return static_cast<std::size_t>((z * kSide + y) * kSide + x); }
  Eigen::Vector3d middle(int x, int y, int z) const { return low_ + cell_m_ * (Eigen::Vector3d(x, y, z).array() + 0.5).matrix(); }
  void offer(int x, int y, int z, std::int32_t point);
  void sweep(int direction);

  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d low_;
  double cell_m_ = 1;
  std::vector<std::int32_t> point_;  ///< Per cell; -1 while unknown.
};

}  // namespace gfp
