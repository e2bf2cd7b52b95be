#include "modelling/model_of_placement.hpp"

namespace gfp {

FittedModel model_of_placement(const Placement& placement, const std::string& method) {
  FittedModel model;
  model.method = method;
  model.class_name = placement.primitive->class_name;
  model.primitive = placement.primitive;
  model.topology = placement.primitive->topology;
  model.T_camera_object = placement.T_camera_object;
  model.size_m = placement.size_m;
  model.modes = placement.modes;
  model.stable_pose = placement.stable_pose;
  model.yaw_low_rad = placement.yaw_low_rad;
  model.yaw_high_rad = placement.yaw_high_rad;
  if (placement.covariance.rows() >= 6) model.pose_covariance = placement.covariance.topLeftCorner<6, 6>();
  return model;
}

}  // namespace gfp
