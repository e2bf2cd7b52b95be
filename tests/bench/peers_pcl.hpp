#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp::bench {

/// PCL 1.13's ways through the same stages, with its buffers kept from call to call.
class PclPeer {
 public:
  PclPeer();
  ~PclPeer();

  void depth_to_cloud(const DepthImage& depth, const CameraModel& camera);  ///< The loop of its OpenNI grabber.
  void set_cloud(const OrganizedCloud& cloud);                              ///< Input of all below.
  void normals();                       ///< IntegralImageNormalEstimation, AVERAGE_3D_GRADIENT.
  NormalMap normal_map() const;         ///< What normals() found.

  /// Its tutorial on Euclidean cluster extraction: voxel grid of 10 mm, RANSAC planes of 20 mm until 30 % are left, clusters of
  /// 20 mm tolerance and at least 100 voxels. Returns how many clusters.
  std::size_t voxel_clusters();
  /// The same without voxels: the greatest plane (10 mm), tolerance 10 mm, at least 500 points. Labels per pixel, -1 for none.
  Image<std::int32_t> dense_clusters();
  /// Organised: 3D-gradient normals, multi-plane segmentation, Euclidean connected components of at least 500 points.
  Image<std::int32_t> organised_clusters();

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

/// pcl::KdTreeFLANN over points.
class PclTree {
 public:
  explicit PclTree(const std::vector<Eigen::Vector3f>& points);
  ~PclTree();
  int within(const Eigen::Vector3f& centre, double radius_m);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace gfp::bench
