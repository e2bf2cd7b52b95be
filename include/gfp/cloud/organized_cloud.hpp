#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/image.hpp"

namespace gfp {

/// The rays (x, y, 1) through the pixels of one camera. Without distortion they are separable: `x` has one entry a
/// column, `y` one a row; with distortion both have one entry a pixel, row-major.
struct RayTable {
  CameraModel camera;
  std::vector<float> x, y;
  bool separable() const { return camera.distortion == DistortionModel::kNone; }
};

/// One point per pixel, camera frame, metres, as three planes (structure of arrays). z = NaN (and x, y) where invalid.
struct OrganizedCloud {
  int width = 0, height = 0;
  std::vector<float> x, y, z;
  CameraModel camera;
  RayTable rays = {};  ///< Of `camera`; kept with the buffer, so that it is made once a camera and not once a frame.

  std::size_t size() const { return z.size(); }
  bool valid(std::size_t i) const { return z[i] == z[i]; }
  Eigen::Vector3f point(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Unit surface normals towards the camera, one per pixel; NaN where there is none.
struct NormalMap {
  int width = 0, height = 0;
  std::vector<float> x, y, z;

  bool valid(std::size_t i) const { return z[i] == z[i]; }
  Eigen::Vector3f normal(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace gfp
