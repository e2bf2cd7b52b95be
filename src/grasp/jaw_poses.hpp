#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gfp/grasp/wrench_space.hpp"
#include "grasp/contact_candidates.hpp"

namespace gfp {

/// A pair of contacts with a direction to come from, camera frame.
struct JawPose {
  Eigen::Vector3d middle;    ///< Of the two contacts.
  Eigen::Vector3d axis;      ///< Closing axis, unit: y of the tcp frame.
  Eigen::Vector3d approach;  ///< Unit: x of the tcp frame.
  double width_m = 0;
};

/// Tool-centre frame whose pads touch at `depth_m` behind their tips.
Transform tcp_frame(const JawPose& pose, double depth_m);

/// Whether two poses are the same grasp for a user: within the distance, approach and closing axis within the angle.
bool alike(const JawPose& a, const JawPose& b, double distance_m, double cos_angle);

/// Poses of all pairs in all approaches, best first, one at a time: few are ever looked at.
///
/// `angles` approaches about each pair's closing axis, none that comes from below (more than 0.05 along `up`). Preferred:
/// head-on contacts, from above, from the camera's side; around the body near the centroid, of a rim or a handle at the end
/// that the jaw reaches first (deeper in, the wall's taper lets it slip).
class JawPoseQueue {
 public:
  JawPoseQueue(const std::vector<AntipodalPair>& pairs, const WrenchScale& scale, const Eigen::Vector3d& up, int angles);
  std::optional<JawPose> next();

 private:
  struct Entry {
    double score;
    std::int32_t pair, angle;
    /// Heap order: worse first; ties by index, so that the order is the same everywhere.
    bool operator<(const Entry& other) const {
      return score != other.score ? score < other.score : pair != other.pair ? pair > other.pair : angle > other.angle;
    }
  };
  /// The frame of approaches about one pair's axis: angle 0 is the steepest way down.
  struct Fan {
    Eigen::Vector3d axis, steepest, sideways;
  };

  const std::vector<AntipodalPair>& pairs_;
  std::vector<Fan> fans_;
  std::vector<Eigen::Vector2d> turns_;  // cosine and sine of each angle
  std::vector<Entry> heap_;
};

}  // namespace gfp
