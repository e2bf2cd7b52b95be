#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// A box of voxels as bits, rows along x padded to whole words.
struct VoxelBits {
  Eigen::Vector3i low = Eigen::Vector3i::Zero();   ///< Lattice cell of the first voxel.
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  int words_per_row = 0;
  std::vector<std::uint64_t> words;

  VoxelBits(const Eigen::Vector3i& low_cell, const Eigen::Vector3i& cells)
      : low(low_cell), size(cells), words_per_row((cells.x() + 63) / 64),
        words(static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(cells.y()) * static_cast<std::size_t>(cells.z()), 0) {}
  std::uint64_t* row(int y, int z) {
    return words.data() + (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(words_per_row);
  }
  const std::uint64_t* row(int y, int z) const { return const_cast<VoxelBits*>(this)->row(y, z); }
};

/// Every set voxel and its six neighbours.
VoxelBits dilated(const VoxelBits& bits);

/// Sets every voxel that the triangle touches. Corners in voxels relative to the box's first voxel; all inside the box.
void mark_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, VoxelBits& bits);

}  // namespace gfp
