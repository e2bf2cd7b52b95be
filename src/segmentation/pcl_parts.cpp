#include "segmentation/pcl_parts.hpp"

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>

namespace gfp {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr std::size_t kLeastPlanePoints = 50;  // PCL's sampling needs a few to choose from
constexpr int kRansacIterations = 200;

Cloud::Ptr to_pcl(const std::vector<Eigen::Vector3f>& points) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // a library does not write to stderr
  const auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(points.size());
  for (const auto& p : points) cloud->emplace_back(p.x(), p.y(), p.z());
  return cloud;
}

}  // namespace

PlaneInliers ransac_plane(const std::vector<Eigen::Vector3f>& points, double inlier_m) {
  if (points.size() < kLeastPlanePoints) return {};
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setOptimizeCoefficients(true);
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setMaxIterations(kRansacIterations);
  segmentation.setDistanceThreshold(inlier_m);
  segmentation.setInputCloud(to_pcl(points));
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  segmentation.segment(inliers, plane);
  if (inliers.indices.empty() || plane.values.size() != 4) return {};
  const Eigen::Vector3d normal(plane.values[0], plane.values[1], plane.values[2]);
  const double length = normal.norm();
  if (!(length > 1e-6)) return {};
  PlaneInliers found{normal / length, static_cast<double>(plane.values[3]) / length, {inliers.indices.begin(), inliers.indices.end()}};
  std::sort(found.inliers.begin(), found.inliers.end());
  return found;
}

std::vector<std::vector<std::int32_t>> euclidean_clusters(const std::vector<Eigen::Vector3f>& points, double tolerance_m, int min_points) {
  if (points.empty()) return {};
  const Cloud::Ptr cloud = to_pcl(points);
  const auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(tolerance_m);
  extraction.setMinClusterSize(min_points);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> found;
  extraction.extract(found);
  std::vector<std::vector<std::int32_t>> clusters;
  for (const auto& cluster : found) {
    clusters.emplace_back(cluster.indices.begin(), cluster.indices.end());
    std::sort(clusters.back().begin(), clusters.back().end());
  }
  std::stable_sort(clusters.begin(), clusters.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return clusters;
}

}  // namespace gfp
