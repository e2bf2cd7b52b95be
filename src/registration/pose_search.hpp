#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "registration/visible_fit.hpp"

namespace gfp {

struct ScoredState {
  PoseState state;
  int stable_pose = 0;
  double score = 0;
};

/// What can be measured of an object before any fit, in the support frame.
struct ObservedExtent {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< Of the seen points.
  Eigen::Vector3d lateral = Eigen::Vector3d::UnitX();  ///< Horizontal, across the line of sight.
  double azimuth_rad = 0;                              ///< Of the line of sight.
  double width_m = 0;                                  ///< 1-99 % extent along `lateral`.
  double height_m = 0;
  double width_sigma = 0.1, height_sigma = 0.04;       ///< Of their logarithms: wide where the view is cut.
  double low_m = 0, high_m = 0;                        ///< Ends of the width: lateral . point.
  bool low_open = false, high_open = false;            ///< There an occluder or the image's border is: the object may go on behind it.
};

ObservedExtent observed_extent(const ObjectView& view, const ObservedTile& tile);

/// Steps through the yaws of one stable pose: size from the measured height and width under the class prior, position from the
/// visible centroids, or from the end that is not cut (ALGORITHM 1.1-1.3), then between the steps beside the best ones. The `keep` best, best first.
std::vector<ScoredState> search_yaws(VisibleFit& fit, const ObservedExtent& extent, const Primitive& primitive, int stable_pose, int yaw_steps, int keep);

/// How many distinct yaws of `steps` over the full turn a class needs, given its symmetry when it rests like `pose`.
int distinct_yaws(const Primitive& primitive, const StablePose& pose, int steps);

}  // namespace gfp
