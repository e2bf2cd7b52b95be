#include "bench/peers_pcl.hpp"

#include <pcl/console/print.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/euclidean_cluster_comparator.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/organized_connected_component_segmentation.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <limits>

namespace gfp::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kPlanePixels = 10'000, kClusterPixels = 500;

/// The indices of the greatest plane; empty where there is none.
pcl::PointIndices::Ptr greatest_plane(const Cloud::Ptr& cloud, double threshold_m) {
  pcl::SACSegmentation<Point> segmentation;
  segmentation.setOptimizeCoefficients(true);
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setMaxIterations(100);
  segmentation.setDistanceThreshold(threshold_m);
  segmentation.setInputCloud(cloud);
  const auto inliers = pcl::make_shared<pcl::PointIndices>();
  pcl::ModelCoefficients coefficients;
  segmentation.segment(*inliers, coefficients);
  return inliers;
}

Cloud::Ptr without(const Cloud::Ptr& cloud, const pcl::PointIndices::Ptr& indices) {
  pcl::ExtractIndices<Point> extract;
  extract.setInputCloud(cloud);
  extract.setIndices(indices);
  extract.setNegative(true);
  const auto rest = pcl::make_shared<Cloud>();
  extract.filter(*rest);
  return rest;
}

std::vector<pcl::PointIndices> clusters(const Cloud::Ptr& cloud, const pcl::IndicesPtr& indices, double tolerance_m, int least, int most) {
  const auto tree = pcl::make_shared<pcl::search::KdTree<Point>>();
  if (indices) tree->setInputCloud(cloud, indices);
  else tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<Point> extraction;
  extraction.setClusterTolerance(tolerance_m);
  extraction.setMinClusterSize(least);
  extraction.setMaxClusterSize(most);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  if (indices) extraction.setIndices(indices);
  std::vector<pcl::PointIndices> found;
  extraction.extract(found);
  return found;
}

Image<std::int32_t> label_image(const Cloud& cloud, const std::vector<pcl::PointIndices>& found, std::size_t least) {
  Image<std::int32_t> labels(static_cast<int>(cloud.width), static_cast<int>(cloud.height), -1);
  std::int32_t label = 0;
  for (const auto& cluster : found) {
    if (cluster.indices.size() < least) continue;
    for (const int i : cluster.indices) labels.pixels[static_cast<std::size_t>(i)] = label;
    ++label;
  }
  return labels;
}

}  // namespace

struct PclPeer::Buffers {
  Cloud made;
  Cloud::Ptr cloud = pcl::make_shared<Cloud>();
  pcl::PointCloud<pcl::Normal>::Ptr normals = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
};

PclPeer::PclPeer() : buffers_(std::make_unique<Buffers>()) { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
PclPeer::~PclPeer() = default;

void PclPeer::depth_to_cloud(const DepthImage& depth, const CameraModel& camera) {
  Cloud& cloud = buffers_->made;
  cloud.width = static_cast<std::uint32_t>(depth.pixels.width);
  cloud.height = static_cast<std::uint32_t>(depth.pixels.height);
  cloud.is_dense = false;
  cloud.points.resize(depth.pixels.pixels.size());
  const auto scale = static_cast<float>(depth.scale_m), inverse_fx = static_cast<float>(1 / camera.fx), inverse_fy = static_cast<float>(1 / camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  std::size_t i = 0;
  for (int v = 0; v < depth.pixels.height; ++v)
    for (int u = 0; u < depth.pixels.width; ++u, ++i) {
      Point& point = cloud.points[i];
      const std::uint16_t reading = depth.pixels.pixels[i];
      if (reading == 0) {
        point.x = point.y = point.z = kNaN;
        continue;
      }
      point.z = static_cast<float>(reading) * scale;
      point.x = (static_cast<float>(u) - cx) * point.z * inverse_fx;
      point.y = (static_cast<float>(v) - cy) * point.z * inverse_fy;
    }
}

void PclPeer::set_cloud(const OrganizedCloud& cloud) {
  Cloud& out = *buffers_->cloud;
  out.width = static_cast<std::uint32_t>(cloud.width);
  out.height = static_cast<std::uint32_t>(cloud.height);
  out.is_dense = false;
  out.points.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) out.points[i] = {cloud.x[i], cloud.y[i], cloud.z[i]};
}

void PclPeer::normals() {
  pcl::IntegralImageNormalEstimation<Point, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.02F);
  estimation.setNormalSmoothingSize(10.0F);
  estimation.setInputCloud(buffers_->cloud);
  estimation.compute(*buffers_->normals);
}

NormalMap PclPeer::normal_map() const {
  NormalMap map{static_cast<int>(buffers_->normals->width), static_cast<int>(buffers_->normals->height), {}, {}, {}};
  for (const auto& n : buffers_->normals->points) {
    map.x.push_back(n.normal_x);
    map.y.push_back(n.normal_y);
    map.z.push_back(n.normal_z);
  }
  return map;
}

std::size_t PclPeer::voxel_clusters() {
  pcl::VoxelGrid<Point> grid;
  grid.setInputCloud(buffers_->cloud);
  grid.setLeafSize(0.01F, 0.01F, 0.01F);
  auto rest = pcl::make_shared<Cloud>();
  grid.filter(*rest);
  const std::size_t voxels = rest->size();
  while (static_cast<double>(rest->size()) > 0.3 * static_cast<double>(voxels)) {
    const auto plane = greatest_plane(rest, 0.02);
    if (plane->indices.empty()) break;
    rest = without(rest, plane);
  }
  return clusters(rest, nullptr, 0.02, 100, 25'000).size();
}

Image<std::int32_t> PclPeer::dense_clusters() {
  const auto plane = greatest_plane(buffers_->cloud, 0.01);
  std::vector<std::uint8_t> taken(buffers_->cloud->size());
  for (const int i : plane->indices) taken[static_cast<std::size_t>(i)] = 1;
  const auto rest = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i] && std::isfinite(buffers_->cloud->points[i].z)) rest->push_back(static_cast<int>(i));
  return label_image(*buffers_->cloud, clusters(buffers_->cloud, rest, 0.01, kClusterPixels, 1 << 30), kClusterPixels);
}

Image<std::int32_t> PclPeer::organised_clusters() {
  normals();
  pcl::OrganizedMultiPlaneSegmentation<Point, pcl::Normal, pcl::Label> planes;
  planes.setMinInliers(kPlanePixels);
  planes.setAngularThreshold(pcl::deg2rad(3.0));
  planes.setDistanceThreshold(0.02);
  planes.setInputNormals(buffers_->normals);
  planes.setInputCloud(buffers_->cloud);
  std::vector<pcl::PlanarRegion<Point>, Eigen::aligned_allocator<pcl::PlanarRegion<Point>>> regions;
  std::vector<pcl::ModelCoefficients> coefficients;
  std::vector<pcl::PointIndices> inliers, label_indices, boundaries;
  auto labels = pcl::make_shared<pcl::PointCloud<pcl::Label>>();
  planes.segmentAndRefine(regions, coefficients, inliers, labels, label_indices, boundaries);

  // In PCL 1.13 the "excluded" labels are those that are kept: name what is no plane.
  const auto kept = pcl::make_shared<std::set<std::uint32_t>>();
  for (std::size_t i = 0; i < label_indices.size(); ++i)
    if (label_indices[i].indices.size() < kPlanePixels) kept->insert(static_cast<std::uint32_t>(i));
  const auto comparator = pcl::make_shared<pcl::EuclideanClusterComparator<Point, pcl::Label>>();
  comparator->setInputCloud(buffers_->cloud);
  comparator->setLabels(labels);
  comparator->setExcludeLabels(kept);
  comparator->setDistanceThreshold(0.01F, false);
  pcl::OrganizedConnectedComponentSegmentation<Point, pcl::Label> components(comparator);
  components.setInputCloud(buffers_->cloud);
  pcl::PointCloud<pcl::Label> component_labels;
  std::vector<pcl::PointIndices> found;
  components.segment(component_labels, found);
  return label_image(*buffers_->cloud, found, kClusterPixels);
}

struct PclTree::Buffers {
  pcl::KdTreeFLANN<Point> tree{/*sorted=*/false};
  pcl::Indices indices;
  std::vector<float> squared;
};

PclTree::PclTree(const std::vector<Eigen::Vector3f>& points) : buffers_(std::make_unique<Buffers>()) {
  const auto cloud = pcl::make_shared<Cloud>();
  for (const auto& p : points) cloud->emplace_back(p.x(), p.y(), p.z());
  buffers_->tree.setInputCloud(cloud);
}

PclTree::~PclTree() = default;

int PclTree::within(const Eigen::Vector3f& centre, double radius_m) {
  return buffers_->tree.radiusSearch({centre.x(), centre.y(), centre.z()}, radius_m, buffers_->indices, buffers_->squared);
}

}  // namespace gfp::bench
