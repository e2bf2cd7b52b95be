#include "grasp/jaw_poses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/transform.hpp"

namespace gfp {

using Eigen::Vector3d;

Transform tcp_frame(const JawPose& pose, double depth_m) {
  Transform T_camera_tcp = Transform::Identity();
  T_camera_tcp.linear().col(0) = pose.approach;
  T_camera_tcp.linear().col(1) = pose.axis;
  T_camera_tcp.linear().col(2) = pose.approach.cross(pose.axis);
  T_camera_tcp.translation() = pose.middle + depth_m * pose.approach;
  return T_camera_tcp;
}

bool alike(const JawPose& a, const JawPose& b, double distance_m, double cos_angle) {
  return (a.middle - b.middle).squaredNorm() < distance_m * distance_m && a.approach.dot(b.approach) > cos_angle &&
         std::abs(a.axis.dot(b.axis)) > cos_angle;
}

JawPoseQueue::JawPoseQueue(const std::vector<AntipodalPair>& pairs, const WrenchScale& scale, const Vector3d& up, int angles) : pairs_(pairs) {
  constexpr double kMostUpwards = 0.05;
  for (int k = 0; k < angles; ++k) turns_.emplace_back(std::cos(2 * std::numbers::pi * k / angles), std::sin(2 * std::numbers::pi * k / angles));
  const Vector3d from_camera = scale.centre.normalized();
  heap_.reserve(pairs.size() * turns_.size());
  fans_.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const AntipodalPair& pair = pairs[i];
    const Vector3d axis = (pair.first - pair.second).normalized();
    const Vector3d down = up.dot(axis) * axis - up;
    const Vector3d steepest = down.norm() > 1e-3 ? Vector3d(down.normalized()) : orthonormal_basis(axis).first;
    const Vector3d sideways = axis.cross(steepest);
    fans_.push_back({axis, steepest, sideways});
    const Vector3d off_centre = (0.5 * (pair.first + pair.second) - scale.centre) / scale.radius_m;
    const bool body = pair.spans(scale.centre);
    const double base = 1.0 - pair.cone_use - (body ? 0.6 * off_centre.norm() : 0.0);
    Vector3d wish = 0.2 * from_camera - 0.8 * up;
    if (!body) wish -= 0.6 * off_centre;
    const Eigen::Vector2d gain(wish.dot(steepest), wish.dot(sideways)), upwards(up.dot(steepest), up.dot(sideways));
    for (std::size_t k = 0; k < turns_.size(); ++k)
      if (upwards.dot(turns_[k]) <= kMostUpwards)
        heap_.push_back({base + gain.dot(turns_[k]), static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
  }
  std::make_heap(heap_.begin(), heap_.end());
}

std::optional<JawPose> JawPoseQueue::next() {
  if (heap_.empty()) return std::nullopt;
  std::pop_heap(heap_.begin(), heap_.end());
  const Entry entry = heap_.back();
  heap_.pop_back();
  const AntipodalPair& pair = pairs_[static_cast<std::size_t>(entry.pair)];
  const Fan& fan = fans_[static_cast<std::size_t>(entry.pair)];
  const Eigen::Vector2d& turn = turns_[static_cast<std::size_t>(entry.angle)];
  return JawPose{0.5 * (pair.first + pair.second), fan.axis, turn.x() * fan.steepest + turn.y() * fan.sideways, pair.width_m};
}

}  // namespace gfp
