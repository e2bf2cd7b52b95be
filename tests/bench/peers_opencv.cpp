#include "bench/peers_opencv.hpp"

#include <opencv2/core.hpp>
#include <opencv2/rgbd.hpp>

namespace gfp::bench {

struct OpencvPeer::Buffers {
  cv::Mat_<float> K;
  cv::Mat points, depth_mm, normals;
  cv::Ptr<cv::rgbd::RgbdNormals> linemod;
};

OpencvPeer::OpencvPeer(const CameraModel& camera) : buffers_(std::make_unique<Buffers>()) {
  cv::setNumThreads(1);
  buffers_->K = (cv::Mat_<float>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  buffers_->linemod = cv::rgbd::RgbdNormals::create(camera.height, camera.width, CV_32F, buffers_->K, 5, cv::rgbd::RgbdNormals::RGBD_NORMALS_METHOD_LINEMOD);
}

OpencvPeer::~OpencvPeer() = default;

void OpencvPeer::depth_to_cloud(const DepthImage& depth) {
  const cv::Mat image(depth.pixels.height, depth.pixels.width, CV_16UC1, const_cast<std::uint16_t*>(depth.pixels.pixels.data()));
  cv::rgbd::depthTo3d(image, buffers_->K, buffers_->points);
}

void OpencvPeer::set_cloud(const OrganizedCloud& cloud) {
  buffers_->depth_mm.create(cloud.height, cloud.width, CV_16UC1);
  auto* out = buffers_->depth_mm.ptr<std::uint16_t>();
  for (std::size_t i = 0; i < cloud.size(); ++i) out[i] = cloud.valid(i) ? static_cast<std::uint16_t>(1000.0F * cloud.z[i] + 0.5F) : 0;
}

void OpencvPeer::normals() { (*buffers_->linemod)(buffers_->depth_mm, buffers_->normals); }

NormalMap OpencvPeer::normal_map() const {
  NormalMap map{buffers_->normals.cols, buffers_->normals.rows, {}, {}, {}};
  for (int i = 0; i < map.width * map.height; ++i) {
    const auto& n = buffers_->normals.at<cv::Vec3f>(i);
    map.x.push_back(n[0]);
    map.y.push_back(n[1]);
    map.z.push_back(n[2]);
  }
  return map;
}

}  // namespace gfp::bench
