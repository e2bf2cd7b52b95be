#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// A class-free body as it was fitted: support frame (z up, support z = 0), metres.
struct SupportedBody {
  std::string method;
  std::shared_ptr<const Topology> topology;
  std::vector<Eigen::Vector3d> vertices_support;
  Eigen::Vector3d axis_support = Eigen::Vector3d::UnitX();  ///< Its horizontal part becomes the object's x axis.
  double surface_sigma_m = 0.001;  ///< How far the seen points lie from the body, 1 sigma.
  /// Information about its pose from the data: translation in the support frame, rotation about axes parallel to it through `centre_support`.
  Eigen::Matrix<double, 6, 6> pose_information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d centre_support = Eigen::Vector3d::Zero();
};

/// The FittedModel of a body: object frame with z up through the base centre, vertices on or above the support (the body is lifted
/// where it is below), states, sigma per vertex, evidence and pose covariance (object frame, tangent at the right).
FittedModel volume_model(const ObjectView& view, const SupportedBody& body);

/// 1-sigma per vertex, metres, where only distances tell: `surface_sigma_m` where observed; elsewhere it grows with the distance to the
/// nearest observed vertex.
std::vector<float> sigma_by_distance(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::uint8_t>& states, double surface_sigma_m);

}  // namespace gfp
