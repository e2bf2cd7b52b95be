#pragma once

#include <Eigen/Core>
#include <vector>

namespace gfp {

/// One seen surface point of an object, support frame (z up from the table), metres; the normal is zero where unknown.
struct SeenPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

inline constexpr int kDescriptorSize = 28;
using ViewDescriptor = Eigen::Matrix<double, kDescriptorSize, 1>;

/// What one view tells of an object's class: metric height, width and depth, the width and the reach in depth by height, asymmetry,
/// and which way its surface faces (ALGORITHM 4). Invariant to where on the table it stands and to the azimuth it is seen from.
/// @param sight_azimuth_rad  of the horizontal line of sight, from the camera to the object.
/// @param points  at least one.
ViewDescriptor describe_view(const std::vector<SeenPoint>& points, double sight_azimuth_rad);

}  // namespace gfp
