#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <memory>

#include "modelling/point_count.hpp"

namespace gfp {
namespace {

/// The tree with the buffers of its answers: one thread at a time, as all of a fit is.
struct CountingTree {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree{/*sorted=*/false};
  pcl::Indices indices;
  std::vector<float> squared;
};

}  // namespace

PointCount count_by_kd_tree(std::span<const Eigen::Vector3f> points, float radius_m) {
  if (points.empty()) return [](const Eigen::Vector3f&) { return 0; };
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : points) cloud->emplace_back(p.x(), p.y(), p.z());
  const auto counting = std::make_shared<CountingTree>();
  counting->tree.setInputCloud(cloud);
  return [counting, radius_m](const Eigen::Vector3f& place) {
    return counting->tree.radiusSearch({place.x(), place.y(), place.z()}, static_cast<double>(radius_m), counting->indices, counting->squared);
  };
}

}  // namespace gfp
