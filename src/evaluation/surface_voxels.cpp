// Conservative voxelisation of a triangle: a unit box meets it iff it meets its plane and its three axis projections
// (Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", 2010).
#include "surface_voxels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfp {
namespace {

using Vec = Eigen::Vector3d;
constexpr double kRounding = 1e-9;  // voxels; errs on the side of marking

// One axis projection: the unit square at (p, q) meets the projected triangle iff all three edge functions are >= 0.
struct Projection {
  std::array<double, 3> along_p, along_q, offset;

  Projection(const std::array<Vec, 3>& corners, int p, int q, double orientation) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec& from = corners[i];
      const Vec edge = corners[(i + 1) % 3] - from;
      along_p[i] = -edge[q] * orientation;
      along_q[i] = edge[p] * orientation;
      offset[i] = -(along_p[i] * from[p] + along_q[i] * from[q]) + std::max(0.0, along_p[i]) + std::max(0.0, along_q[i]) +
                  kRounding * (std::abs(along_p[i]) + std::abs(along_q[i]) + 1.0);
    }
  }
  bool meets(double p, double q) const {
    return along_p[0] * p + along_q[0] * q + offset[0] >= 0 && along_p[1] * p + along_q[1] * q + offset[1] >= 0 &&
           along_p[2] * p + along_q[2] * q + offset[2] >= 0;
  }
};

void add_row(const std::uint64_t* from, std::uint64_t* to, int words) {
  for (int i = 0; i < words; ++i) to[i] |= from[i];
}

}  // namespace

VoxelBits dilated(const VoxelBits& bits) {
  VoxelBits result = bits;
  const int words = bits.words_per_row;
  for (int z = 0; z < bits.size.z(); ++z)
    for (int y = 0; y < bits.size.y(); ++y) {
      const std::uint64_t* row = bits.row(y, z);
      std::uint64_t* out = result.row(y, z);
      for (int i = 0; i < words; ++i) {
        out[i] |= (row[i] << 1) | (row[i] >> 1);
        if (i > 0) out[i] |= row[i - 1] >> 63;
        if (i + 1 < words) out[i] |= row[i + 1] << 63;
      }
      if (y > 0) add_row(bits.row(y - 1, z), out, words);
      if (y + 1 < bits.size.y()) add_row(bits.row(y + 1, z), out, words);
      if (z > 0) add_row(bits.row(y, z - 1), out, words);
      if (z + 1 < bits.size.z()) add_row(bits.row(y, z + 1), out, words);
    }
  return result;
}

void mark_triangle(const Vec& a, const Vec& b, const Vec& c, VoxelBits& bits) {
  const std::array<Vec, 3> corners{a, b, c};
  const Vec normal = (b - a).cross(c - a);
  const Eigen::Vector3i first = a.cwiseMin(b).cwiseMin(c).array().floor().matrix().cast<int>();
  const Eigen::Vector3i last = a.cwiseMax(b).cwiseMax(c).array().floor().matrix().cast<int>();
  const Projection yz(corners, 1, 2, normal.x() >= 0 ? 1.0 : -1.0);
  const Projection zx(corners, 2, 0, normal.y() >= 0 ? 1.0 : -1.0);
  const Projection xy(corners, 0, 1, normal.z() >= 0 ? 1.0 : -1.0);
  // The box's corner farthest along the normal and its opposite, relative to the box's low corner.
  const Vec farthest = (normal.array() > 0).cast<double>().matrix(), nearest = Vec::Ones() - farthest;
  const double slack = kRounding * (normal.lpNorm<1>() + 1.0);
  const double upper = normal.dot(farthest - a) + slack, lower = normal.dot(nearest - a) - slack;
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      if (!yz.meets(y, z)) continue;
      // Boxes that meet the plane: lower <= -(n . p) <= upper, an interval in x.
      const double rest = normal.y() * y + normal.z() * z;
      int x0 = first.x(), x1 = last.x();
      if (std::abs(normal.x()) > slack) {
        const double s = (-rest - upper) / normal.x(), t = (-rest - lower) / normal.x();
        const double begin = std::clamp(std::min(s, t), -1.0, x1 + 1.0), end = std::clamp(std::max(s, t), -1.0, x1 + 1.0);
        x0 = std::max(x0, static_cast<int>(std::ceil(begin - kRounding)));
        x1 = std::min(x1, static_cast<int>(std::floor(end + kRounding)));
      } else if (const double tilt = std::abs(normal.x()) * (last.x() + 1); rest + upper + tilt < 0 || rest + lower - tilt > 0) {
        continue;  // nearly parallel to x: the plane does not move by more than `tilt` over the whole row
      }
      std::uint64_t* row = bits.row(y, z);
      for (int x = x0; x <= x1; ++x)
        if (zx.meets(z, x) && xy.meets(x, y)) row[x >> 6] |= std::uint64_t{1} << (x & 63);
    }
  }
}

}  // namespace gfp
