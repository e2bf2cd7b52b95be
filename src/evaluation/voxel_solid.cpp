#include "gfp/evaluation/voxel_solid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <string>

#include "surface_voxels.hpp"

namespace gfp {
namespace {

using Run = VoxelSolid::Run;
constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 30;

std::span<const Run> row_of(const VoxelSolid& solid, int y, int z) {
  if (y < 0 || z < 0 || y >= solid.size.y() || z >= solid.size.z()) return {};
  const std::size_t row = static_cast<std::size_t>(z) * static_cast<std::size_t>(solid.size.y()) + static_cast<std::size_t>(y);
  return {solid.runs.data() + solid.offsets[row], solid.runs.data() + solid.offsets[row + 1]};
}

std::int64_t length(std::span<const Run> runs) {
  std::int64_t sum = 0;
  for (const Run& run : runs) sum += run.last - run.first;
  return sum;
}

std::int64_t common_length(std::span<const Run> a, std::span<const Run> b) {
  std::int64_t sum = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    sum += std::max(0, std::min(a[i].last, b[j].last) - std::max(a[i].first, b[j].first));
    if (a[i].last < b[j].last) ++i; else ++j;
  }
  return sum;
}

// The stretches of unset voxels of a box, row by row; where each is in the flood.
struct AirRuns {
  enum State : std::uint8_t { kEnclosed, kWet, kDry };  // wet: reached, but only by rising above it
  std::vector<std::int32_t> offsets, first, last, row;
  std::vector<State> state;
};

AirRuns find_air(const VoxelBits& surface) {
  AirRuns air;
  air.offsets.push_back(0);
  const int width = surface.size.x(), rows = surface.size.y() * surface.size.z();
  for (int r = 0; r < rows; ++r) {
    const std::uint64_t* words = surface.words.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(surface.words_per_row);
    const auto next = [&](int x, bool solid) {  // first voxel at or after x that is (not) solid
      while (x < width) {
        const std::uint64_t word = (solid ? words[x >> 6] : ~words[x >> 6]) >> (x & 63);
        if (word != 0) return std::min(width, x + std::countr_zero(word));
        x = (x | 63) + 1;
      }
      return width;
    };
    for (int x = next(0, false); x < width;) {
      const int end = next(x, true);
      air.first.push_back(x);
      air.last.push_back(end);
      air.row.push_back(r);
      x = next(end, false);
    }
    air.offsets.push_back(static_cast<std::int32_t>(air.first.size()));
  }
  air.state.assign(air.first.size(), AirRuns::kEnclosed);
  return air;
}

// Floods slice by slice from below: at level z only runs at or below z may be entered, so what is first reached at its own
// level is dry and what is reached later can be left only by rising above it. The box has a margin of air all around.
void flood(const Eigen::Vector3i& size, AirRuns& air) {
  const int ny = size.y(), nz = size.z();
  std::vector<std::vector<std::int32_t>> above(static_cast<std::size_t>(nz) + 1);
  std::vector<std::int32_t> stack;
  for (int level = 0; level < nz; ++level) {
    stack.swap(above[static_cast<std::size_t>(level)]);
    for (int y = 0; y < ny; ++y) {  // the margin: first and last run of each row
      const std::size_t row = static_cast<std::size_t>(level * ny + y);
      stack.push_back(air.offsets[row]);
      stack.push_back(air.offsets[row + 1] - 1);
    }
    while (!stack.empty()) {
      const std::size_t run = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      if (air.state[run] != AirRuns::kEnclosed) continue;
      const int row = air.row[run], y = row % ny, z = row / ny;
      air.state[run] = z == level ? AirRuns::kDry : AirRuns::kWet;
      const auto visit = [&](int next_y, int next_z) {
        if (next_y < 0 || next_y >= ny || next_z < 0 || next_z >= nz) return;
        const std::size_t next_row = static_cast<std::size_t>(next_z * ny + next_y);
        auto& list = next_z > level ? above[static_cast<std::size_t>(next_z)] : stack;
        for (std::int32_t i = air.offsets[next_row]; i < air.offsets[next_row + 1]; ++i) {
          const std::size_t other = static_cast<std::size_t>(i);
          if (air.first[other] >= air.last[run]) break;
          if (air.last[other] > air.first[run] && air.state[other] == AirRuns::kEnclosed) list.push_back(i);
        }
      };
      visit(y - 1, z);
      visit(y + 1, z);
      visit(y, z - 1);
      visit(y, z + 1);
    }
  }
}

// The voxels of all air runs for which `open` holds.
template <class Open>
VoxelBits open_voxels(const VoxelBits& box, const AirRuns& air, Open&& open) {
  VoxelBits bits(box.low, box.size);
  for (std::size_t run = 0; run < air.state.size(); ++run) {
    if (!open(air.state[run])) continue;
    std::uint64_t* words = bits.words.data() + static_cast<std::size_t>(air.row[run]) * static_cast<std::size_t>(bits.words_per_row);
    for (int x = air.first[run]; x < air.last[run];) {  // whole words at a time
      const int end = std::min(air.last[run], (x | 63) + 1), count = end - x;
      words[x >> 6] |= (count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1) << (x & 63);
      x = end;
    }
  }
  return bits;
}

// All voxels of the box that are not open.
VoxelSolid complement(const VoxelBits& open, double voxel_m) {
  VoxelSolid solid{voxel_m, open.low, open.size, {0}, {}};
  const AirRuns closed = find_air(open);  // the stretches between open voxels
  for (std::size_t i = 0; i < closed.first.size(); ++i) solid.runs.push_back({open.low.x() + closed.first[i], open.low.x() + closed.last[i]});
  solid.offsets = closed.offsets;
  return solid;
}

// Grows what the flood reached back by the voxel that sealing took, but not into the surface.
void grow_back(const VoxelBits& surface, VoxelBits& open) {
  open = dilated(open);
  for (std::size_t i = 0; i < open.words.size(); ++i) open.words[i] &= ~surface.words[i];
}

}  // namespace

std::int64_t VoxelSolid::voxels() const { return length(runs); }

bool VoxelSolid::contains(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d cell = (point / voxel_m).array().floor() - low.cast<double>().array();
  if ((cell.array() < 0).any() || (cell.array() >= size.cast<double>().array()).any()) return false;
  const int x = low.x() + static_cast<int>(cell.x());
  for (const Run& run : row_of(*this, static_cast<int>(cell.y()), static_cast<int>(cell.z())))
    if (x >= run.first && x < run.last) return true;
  return false;
}

double VoxelSolid::volume_m3() const {
  std::int64_t faces = 2 * static_cast<std::int64_t>(runs.size());
  for (int z = 0; z <= size.z(); ++z)
    for (int y = 0; y <= size.y(); ++y) {
      const auto row = row_of(*this, y, z), before_y = row_of(*this, y - 1, z), before_z = row_of(*this, y, z - 1);
      faces += length(row) + length(before_y) - 2 * common_length(row, before_y);
      faces += length(row) + length(before_z) - 2 * common_length(row, before_z);
    }
  return (static_cast<double>(voxels()) - 0.5 * static_cast<double>(faces)) * voxel_m * voxel_m * voxel_m;
}

Result<FilledSolid> fill_solid(const TriangleMesh& mesh, double voxel_m, bool seal_pinholes) {
  if (mesh.triangles.empty()) return failure(ErrorCode::kInvalidArgument, "mesh has 0 triangles, expected at least 1");
  if (!(voxel_m > 0)) return failure(ErrorCode::kInvalidArgument, "voxel_m = " + std::to_string(voxel_m) + ", expected > 0");
  for (const auto& v : mesh.vertices)
    if (!v.allFinite()) return failure(ErrorCode::kInvalidArgument, "mesh has a vertex that is not finite");
  const Bounds box = bounds(mesh.vertices);
  const Eigen::Array3d low = (box.low / voxel_m).array().floor() - 2, high = (box.high / voxel_m).array().floor() + 3;
  if (low.abs().maxCoeff() > 1e8 || high.abs().maxCoeff() > 1e8 || (high - low).prod() > static_cast<double>(kMaxVoxels))
    return failure(ErrorCode::kTooLarge, "mesh spans " + std::to_string(box.size().maxCoeff()) + " m, expected at most 2^30 voxels of " + std::to_string(voxel_m) + " m");
  VoxelBits surface(low.cast<int>(), (high - low).cast<int>());
  const auto in_voxels = [&](std::int32_t vertex) -> Eigen::Vector3d {
    return (mesh.vertices[static_cast<std::size_t>(vertex)] / voxel_m).array() - low;
  };
  for (const Triangle& t : mesh.triangles) mark_triangle(in_voxels(t[0]), in_voxels(t[1]), in_voxels(t[2]), surface);
  AirRuns air = find_air(seal_pinholes ? dilated(surface) : surface);
  flood(surface.size, air);
  VoxelBits reached = open_voxels(surface, air, [](AirRuns::State s) { return s != AirRuns::kEnclosed; });
  VoxelBits dry = open_voxels(surface, air, [](AirRuns::State s) { return s == AirRuns::kDry; });
  if (seal_pinholes) {
    grow_back(surface, reached);
    grow_back(surface, dry);
  }
  return FilledSolid{complement(reached, voxel_m), complement(dry, voxel_m)};
}

double filled_volume_m3(const TriangleMesh& mesh, const FilledSolid& solid) {
  const MeshTopology topology = examine_topology(mesh);
  if (topology.boundary_edges > 0 || topology.components != 1) return solid.filled.volume_m3();
  return signed_volume(mesh) + solid.filled.volume_m3() - solid.material.volume_m3();
}

double intersection_over_union(const VoxelSolid& a, const VoxelSolid& b) {
  std::int64_t common = 0;
  for (int z = 0; z < a.size.z(); ++z)
    for (int y = 0; y < a.size.y(); ++y)
      common += common_length(row_of(a, y, z), row_of(b, y + a.low.y() - b.low.y(), z + a.low.z() - b.low.z()));
  const std::int64_t all = a.voxels() + b.voxels() - common;
  return all > 0 ? static_cast<double>(common) / static_cast<double>(all) : 0.0;
}

}  // namespace gfp
