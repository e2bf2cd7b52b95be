#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "evaluation/surface_voxels.hpp"

namespace gfp::test {

/// Whether a triangle has a point in the cube [low, low + 1] grown by `margin`: Sutherland-Hodgman clipping leaves something.
inline bool clips(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& low, double margin) {
  std::vector<Eigen::Vector3d> polygon(corners.begin(), corners.end());
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      const double limit = side > 0 ? low[axis] + 1 + margin : -(low[axis] - margin);
      std::vector<Eigen::Vector3d> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double sp = limit - side * p[axis], sq = limit - side * q[axis];
        if (sp >= 0) kept.push_back(p);
        if ((sp >= 0) != (sq >= 0)) kept.push_back(p + (q - p) * (sp / (sp - sq)));
      }
      polygon = std::move(kept);
    }
  return !polygon.empty();
}

inline void expect_marks_exactly(const std::array<Eigen::Vector3d, 3>& corners, int trial) {
  VoxelBits bits(Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(12));
  mark_triangle(corners[0], corners[1], corners[2], bits);
  for (int z = 0; z < 12; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x) {
        const bool marked = ((bits.row(y, z)[0] >> x) & 1U) != 0;
        const bool must = clips(corners, Eigen::Vector3d(x, y, z), -1e-6), may = clips(corners, Eigen::Vector3d(x, y, z), 1e-6);
        EXPECT_TRUE(marked ? may : !must) << "trial " << trial << ", voxel " << x << ' ' << y << ' ' << z << ", marked " << marked;
      }
}

}  // namespace gfp::test
