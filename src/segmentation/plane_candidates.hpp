#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "segmentation/inverse_depth_fit.hpp"

namespace gfp {

/// Every `stride`-th pixel of every `stride`-th row as ray and inverse depth; inverse depth 0 where there is no reading.
struct SampleGrid {
  int stride = 1, width = 0, height = 0;
  std::vector<float> ray_x, ray_y, inverse_depth;
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i); }
  bool valid(std::size_t s) const { return inverse_depth[s] > 0; }
  Eigen::Vector3d point(std::size_t s) const { return Eigen::Vector3d(ray_x[s], ray_y[s], 1.0) / inverse_depth[s]; }
};

/// About 120 samples on the shorter side.
SampleGrid sample_grid(const OrganizedCloud& cloud);

/// A flat part of the scene, of any orientation.
struct PlaneCandidate {
  PlaneFit fit;
  std::vector<std::int32_t> samples;  ///< Indices into the grid of those that lie on it, ascending.
};

/// Flat parts of the scene, the one with most samples first: cells of 4 x 4 samples are fitted, grown into regions over
/// neighbours that continue the plane, joined where an object divides one plane, and fitted again to all their samples.
/// Deterministic: no random draws, ties by index.
std::vector<PlaneCandidate> plane_candidates(const SampleGrid& grid);

/// Fits `start` to the samples within `band` times the noise (rms of the residuals), a few times over.
/// `region` limits the samples where it is not empty (one flag per sample).
PlaneCandidate refine_plane(const SampleGrid& grid, const PlaneFit& start, const std::vector<std::uint8_t>& region);

}  // namespace gfp
