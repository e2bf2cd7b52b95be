#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

/// Voxels of a body as runs along x, on the lattice whose cell (i, j, k) is [i, i + 1) x [j, j + 1) x [k, k + 1) voxels.
struct VoxelSolid {
  struct Run {
    std::int32_t first, last;  ///< Lattice x, half-open.
  };
  double voxel_m = 0;
  Eigen::Vector3i low = Eigen::Vector3i::Zero();   ///< Lattice cell of the first row.
  Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< Rows: size.y() * size.z(), z outermost.
  std::vector<std::int32_t> offsets;               ///< Row r holds runs[offsets[r] .. offsets[r + 1]), ascending.
  std::vector<Run> runs;

  std::int64_t voxels() const;
  bool contains(const Eigen::Vector3d& point) const;
  /// Volume of the body, m^3. Each voxel that the surface touches counts as solid, which adds half a voxel under every
  /// exposed voxel face; that half is taken off again, so that the estimate has no bias on curved and
  /// leaning surfaces; a face along the lattice is off by up to half a voxel.
  double volume_m3() const;
};

/// A mesh as a body, twice: its material, and with its cavities filled as water would fill them.
struct FilledSolid {
  VoxelSolid material;  ///< All that cannot be reached from outside.
  VoxelSolid filled;    ///< And every place that can be left only by going above it: a cup up to the lowest point of its rim.
};

/// Fills a mesh whose up axis is z (metres; any frame with z up).
///
/// Every voxel that a triangle touches is solid (conservative, so meshes with small cracks, touching parts and inner shells are
/// fine); the rest is flooded from outside. A voxel at height z is dry when outside can be reached without rising above z:
/// that closes a cup with a lid at the lowest point of its rim and leaves the hole of its handle open.
/// Errors: kInvalidArgument (no triangles, non-finite vertices), kTooLarge (more than 2^30 voxels in the bounding box).
/// `seal_pinholes` keeps the flood out of gaps up to two voxels wide (a morphological closing): scans have such tunnels.
/// Cost: O(surface voxels + rows); about 4 ms for a mug at 1 mm.
Result<FilledSolid> fill_solid(const TriangleMesh& mesh, double voxel_m = 0.001, bool seal_pinholes = false);

/// Volume of the mesh with its cavities filled, m^3. One closed component has its exact volume (divergence theorem) plus the
/// voxel estimate of its cavities, so that solid bodies carry no quantisation; other meshes get the voxel estimate of all.
double filled_volume_m3(const TriangleMesh& mesh, const FilledSolid& solid);

/// Volume of the intersection over volume of the union; both on the same lattice. 0 where both are empty.
double intersection_over_union(const VoxelSolid& a, const VoxelSolid& b);

}  // namespace gfp
