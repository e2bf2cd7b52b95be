#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include "registration/align_icp.hpp"

namespace gfp {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL computes in single precision: about the target's middle it loses least.
Cloud::Ptr to_pcl(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& origin) {
  const auto cloud = pcl::make_shared<Cloud>();
  for (const auto& p : points) {
    const Eigen::Vector3f q = (p - origin).cast<float>();
    cloud->emplace_back(q.x(), q.y(), q.z());
  }
  return cloud;
}

/// The nearest rigid motion to PCL's matrix, moved back from the origin used.
Transform rigid(const Eigen::Matrix4f& matrix, const Eigen::Vector3d& origin) {
  const Eigen::Matrix4d m = matrix.cast<double>();
  Transform transform = Transform::Identity();
  transform.linear() = Eigen::Quaterniond(Eigen::Matrix3d(m.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  transform.translation() = m.topRightCorner<3, 1>() + origin - transform.linear() * origin;
  return transform;
}

}  // namespace

IcpResult align_icp_pcl(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target, int max_iterations) {
  if (source.size() < 3 || target.size() < 3 || max_iterations < 1) return {};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (const auto& p : target) origin += p / static_cast<double>(target.size());
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(to_pcl(source, origin));
  icp.setInputTarget(to_pcl(target, origin));
  icp.setMaximumIterations(max_iterations);
  icp.setTransformationEpsilon(1e-10);
  Cloud moved;
  icp.align(moved);
  if (!icp.getFinalTransformation().allFinite()) return {};
  return {rigid(icp.getFinalTransformation(), origin), icp.getFitnessScore(), icp.hasConverged(), max_iterations};
}

}  // namespace gfp
