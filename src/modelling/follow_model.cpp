#include "gfp/modelling/follow_model.hpp"

#include "gfp/modelling/evaluate_fit.hpp"

namespace gfp {

FittedModel follow_model(const ObjectView& view, const FittedModel& before, const FollowedPose& pose) {
  FittedModel model = before;
  model.T_camera_object = pose.T_camera_object;
  model.pose_covariance = pose.covariance;
  const double mahalanobis = model.evidence.mahalanobis;  // of size and modes, which stay
  model.evidence = evaluate_fit(view, model.vertices_camera(), model.topology->triangles, model.states);
  model.evidence.mahalanobis = mahalanobis;
  for (std::size_t i = 0; i < model.states.size(); ++i) model.states[i] |= before.states[i] & kVertexObserved;
  return model;
}

}  // namespace gfp
