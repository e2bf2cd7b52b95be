#include "gfp/registration/follow_shape.hpp"

#include "registration/visible_fit.hpp"

namespace gfp {
namespace {

constexpr int kSteps = 5;
constexpr double kSettled = 3e-4;        ///< Metres and radians: well below the noise.
constexpr double kRigid = 1e-6;          ///< Log size: what may not change is given no room.
constexpr double kSignificant = 0.02;    ///< Score, about a nat, by which a move must explain the view better: what stands does not tremble with the noise.
constexpr double kRobustM[] = {0.010, 0.006, 0.004};

/// A primitive that is this one body.
Primitive rigid_body(const std::vector<Eigen::Vector3d>& vertices, const std::shared_ptr<const Topology>& topology) {
  Primitive body;
  body.mean = vertices;
  body.topology = topology;
  body.log_size_covariance = kRigid * kRigid * Eigen::Matrix3d::Identity();
  return body;
}

}  // namespace

FollowedPose follow_shape(const ObjectView& view, const std::vector<Eigen::Vector3d>& vertices, const std::shared_ptr<const Topology>& topology,
                          const Transform& T_camera_object, const RegistrationOptions& options) {
  const Primitive body = rigid_body(vertices, topology);
  const SearchTile now(observe(view, options.sample_pixels));  // what it was seen like before says nothing of where it is
  VisibleFit fit({&now, 1}, body, view.has_support);
  PoseState state;
  state.T_support_object = view.T_camera_support.inverse() * T_camera_object;
  fit.pose(state);
  const PoseState stood = state;
  const double score_where_it_stood = fit.score();
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::VectorXd step = fit.step({.robust_m = kRobustM[std::min(k, 2)]}, 1e-4);
    state.apply(step);
    fit.pose(state);
    if (step.head<PoseState::kPose>().cwiseAbs().maxCoeff() < kSettled) break;
  }
  const bool stands = fit.score() > score_where_it_stood - kSignificant;
  if (stands) fit.pose(stood);
  fit.step({.robust_m = kRobustM[2]}, 0);
  FollowedPose followed;
  followed.T_camera_object = stands ? T_camera_object : view.T_camera_support * state.T_support_object;
  followed.covariance = fit.information().topLeftCorner<6, 6>().ldlt().solve(Eigen::Matrix<double, 6, 6>::Identity());
  return followed;
}

}  // namespace gfp
