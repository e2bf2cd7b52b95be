#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gfp {

/// A point found by a search: its place in what the grid was made of, and its squared distance from the centre.
struct Neighbour {
  std::int32_t index = -1;
  float squared_m2 = 0;
};

/// Points sorted into cubic cells, for exact searches within a radius: no tree.
///
/// The points are counting-sorted by cell, x fastest, so that the cells of one row along x are one run in memory: a search
/// looks at a few contiguous runs of coordinates, eight points at a time. Best where the cell is about the radius.
/// A point is within the radius if fl(dx^2 + dy^2 + dz^2) <= fl(radius^2), single precision, in this order.
/// Immutable: safe from any thread.
class VoxelGrid {
 public:
  /// @param points  metres, any frame; those that are not finite are never found. @param cell_m  edge of a cell, > 0; grows where
  ///         the points' bounding box would otherwise take more than kMaxCells cells (16 bytes a point and 4 a cell are allocated).
  VoxelGrid(std::span<const Eigen::Vector3f> points, float cell_m);

  static constexpr std::int64_t kMaxCells = 1 << 21;

  std::size_t size() const { return index_.size(); }
  float cell_m() const { return cell_m_; }

  /// How many points lie within `radius_m` of `centre`. Cost: 50 to 200 ns where the cell is the radius and up to 150 points are inside.
  int count_within(const Eigen::Vector3f& centre, float radius_m) const;

  /// Those points, in the order of the cells. `buffer` is scratch that only grows; the answer lives in it.
  std::span<const Neighbour> find_within(const Eigen::Vector3f& centre, float radius_m, std::vector<Neighbour>& buffer) const;

  /// The nearest point within `radius_m`; of equally near ones that of the lowest index. Nothing where there is none.
  std::optional<Neighbour> nearest(const Eigen::Vector3f& centre, float radius_m) const;

 private:
  struct Block;
  Block block_around(const Eigen::Vector3f& centre, float radius_m) const;
  int cell_along(int axis, float coordinate) const;
  std::int64_t cell_of(const Eigen::Vector3f& point) const;

  float cell_m_ = 1, inverse_cell_ = 1;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<std::int32_t> start_;  ///< Per cell: where its points start; one more at the end.
  std::vector<float> x_, y_, z_;     ///< By cell.
  std::vector<std::int32_t> index_;  ///< By cell: the point's place in the constructor's span.
};

}  // namespace gfp
