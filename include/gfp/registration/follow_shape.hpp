#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/primitive/primitive.hpp"
#include "gfp/registration/register_primitive.hpp"

namespace gfp {

/// Moves a rigid closed surface (`vertices`, object frame, metres) from `T_camera_object` onto what is seen now: the residuals of
/// register_primitive, six unknowns. No search: the guess must be within a few centimetres and degrees. Where that guess explains the view as
/// well as the noise allows, it is the answer: what stands, and the yaw of what is round, stay as they are to the last bit. Whether the shape still is
/// the right one is for the caller to judge. Cost: 0.5 ms.
FollowedPose follow_shape(const ObjectView& view, const std::vector<Eigen::Vector3d>& vertices, const std::shared_ptr<const Topology>& topology,
                          const Transform& T_camera_object, const RegistrationOptions& options = {});

}  // namespace gfp
