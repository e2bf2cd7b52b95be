#pragma once

#include <memory>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp::bench {

/// OpenCV's rgbd module, single thread, with its buffers kept from call to call.
class OpencvPeer {
 public:
  explicit OpencvPeer(const CameraModel& camera);
  ~OpencvPeer();

  void depth_to_cloud(const DepthImage& depth);   ///< cv::rgbd::depthTo3d.
  void set_cloud(const OrganizedCloud& cloud);    ///< Input of normals(), as depth in millimetres: with points LINEMOD of 4.6 crashes.
  void normals();                                 ///< cv::rgbd::RgbdNormals, LINEMOD, window 5.
  NormalMap normal_map() const;                   ///< What normals() found.

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace gfp::bench
