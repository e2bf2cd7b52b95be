#include "gfp/primitive/stable_poses.hpp"

extern "C" {
#include <libqhull_r/libqhull_r.h>
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace gfp {
namespace {

/// A face of the hull on which the object can rest.
struct Rest {
  Eigen::Vector3d normal;  ///< Outwards: down, when it rests.
  double solid_angle = 0;
};

/// Of a triangle seen from the origin (van Oosterom and Strackee 1983).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::abs(std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb));
}

/// A convex hull by Qhull (its C interface: the C++ one is no C++20), freed with the object.
class Hull {
 public:
  explicit Hull(const std::vector<Eigen::Vector3d>& points) {
    for (const auto& p : points) coordinates_.insert(coordinates_.end(), p.data(), p.data() + 3);
    std::FILE* quiet = std::fopen("/dev/null", "w");
    char command[] = "qhull";
    qh_zero(&state_, quiet);
    failed_ = qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.data(), 0, command, quiet, quiet) != 0;
    if (quiet != nullptr) std::fclose(quiet);
  }
  ~Hull() {
    state_.NOerrexit = 1;
    qh_freeqhull(&state_, !qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(&state_, &current, &total);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  /// Calls visit(normal, corners in no order) for every facet; for none where the points are flat or too few.
  template <class Visit>
  void each_facet(Visit&& visit) const {
    for (const facetT* facet = failed_ ? nullptr : state_.facet_list; facet != nullptr && facet->next != nullptr; facet = facet->next) {
      std::vector<Eigen::Vector3d> corners;
      for (auto** vertex = reinterpret_cast<vertexT**>(&facet->vertices->e[0].p); *vertex != nullptr; ++vertex)
        corners.emplace_back((*vertex)->point[0], (*vertex)->point[1], (*vertex)->point[2]);
      visit(Eigen::Vector3d(facet->normal[0], facet->normal[1], facet->normal[2]), std::move(corners));
    }
  }

 private:
  std::vector<double> coordinates_;
  qhT state_{};
  bool failed_ = true;
};

/// Sorts a facet's corners around its normal.
void sort_around(std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& normal) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : corners) middle += p / static_cast<double>(corners.size());
  const auto basis = orthonormal_basis(normal);
  const auto angle = [&](const Eigen::Vector3d& p) { return std::atan2((p - middle).dot(basis.second), (p - middle).dot(basis.first)); };
  std::sort(corners.begin(), corners.end(), [&](const auto& p, const auto& q) { return angle(p) < angle(q); });
}

bool holds_centre(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& normal) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& a = corners[i];
    const Eigen::Vector3d& b = corners[(i + 1) % corners.size()];
    if (normal.dot((b - a).cross(-a)) < 0) return false;
  }
  return true;
}

std::vector<Rest> resting_faces(const TriangleMesh& mesh) {
  const Eigen::Vector3d centre = volume_centroid(mesh);
  std::vector<Rest> rests;
  if (!centre.allFinite() || mesh.vertices.size() < 4) return rests;
  Hull(mesh.vertices).each_facet([&](const Eigen::Vector3d& normal, std::vector<Eigen::Vector3d> corners) {
    for (auto& p : corners) p -= centre;
    sort_around(corners, normal);
    if (!holds_centre(corners, normal)) return;
    Rest rest{normal, 0};
    for (std::size_t i = 2; i < corners.size(); ++i) rest.solid_angle += solid_angle(corners[0], corners[i - 1], corners[i]);
    rests.push_back(rest);
  });
  return rests;
}

/// One representative of all directions that the symmetry makes equal.
Eigen::Vector3d folded(const Eigen::Vector3d& normal, const Symmetry& symmetry) {
  Eigen::Vector3d n = normal;
  if (symmetry.revolution) n = {std::hypot(n.x(), n.y()), 0, n.z()};
  if (symmetry.mirror_x) n.x() = std::abs(n.x());
  if (symmetry.mirror_y) n.y() = std::abs(n.y());
  if (symmetry.flip_z) n.z() = -std::abs(n.z());
  return n;
}

std::vector<Rest> merged(std::vector<Rest> rests, const Symmetry& symmetry, double angle_rad) {
  std::stable_sort(rests.begin(), rests.end(), [](const Rest& a, const Rest& b) { return a.solid_angle > b.solid_angle; });
  std::vector<Rest> groups;
  for (const auto& rest : rests) {
    const Eigen::Vector3d n = folded(rest.normal, symmetry);
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Rest& group) { return n.dot(folded(group.normal, symmetry)) > std::cos(angle_rad); });
    if (same == groups.end()) groups.push_back(rest);
    else same->solid_angle += rest.solid_angle;
  }
  return groups;
}

/// Turns `normal` down by the shortest way; upside down about x.
Eigen::Matrix3d resting_rotation(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  if (normal.dot(down) > 1 - 1e-6) return Eigen::Matrix3d::Identity();
  if (normal.dot(down) < -1 + 1e-6) return rotation_from_vector(std::numbers::pi * Eigen::Vector3d::UnitX());
  return rotation_from_vector(std::acos(std::clamp(normal.dot(down), -1.0, 1.0)) * normal.cross(down).normalized());
}

std::string pose_name(const Eigen::Vector3d& normal, const Symmetry& symmetry) {
  const double down = -normal.z();
  if (down > 0.94) return "upright";
  if (down < -0.94) return symmetry.flip_z ? "upright" : "inverted";
  if (std::abs(down) > 0.7) return "tilted";
  if (symmetry.revolution) return "lying";
  if (std::abs(normal.y()) > std::abs(normal.x())) return "lying_side";
  if (symmetry.mirror_x || symmetry.cyclic > 1) return "lying_face";
  return normal.x() > 0 ? "lying_front" : "lying_back";
}

}  // namespace

std::vector<StablePose> find_stable_poses(const TriangleMesh& mesh, const Symmetry& symmetry, const StablePoseOptions& options) {
  const auto groups = merged(resting_faces(mesh), symmetry, options.merge_angle_rad);
  double other = 0;
  bool upright_found = false;
  std::vector<StablePose> poses;
  for (const auto& group : groups) {
    const Eigen::Vector3d n = symmetry.flip_z && group.normal.z() > 0 ? Eigen::Vector3d(group.normal.x(), group.normal.y(), -group.normal.z()) : group.normal;
    StablePose pose{resting_rotation(n), group.solid_angle, pose_name(n, symmetry)};
    if (pose.name == "upright" && !upright_found) {
      upright_found = true;
      pose.probability = 0;
      if (-n.z() > 0.9994) pose.R_support_object.setIdentity();  // within 2 degrees: rounding of the mean
    } else if (pose.name == "upright") {
      pose.name = "tilted";
    }
    other += pose.probability;
    poses.push_back(pose);
  }
  if (!upright_found && other == 0) return {{Eigen::Matrix3d::Identity(), 1, "upright"}};
  const double share = upright_found ? (other > 0 ? options.upright_share : 1.0) : 0.0;
  for (auto& pose : poses) pose.probability = pose.name == "upright" ? share : (1 - share) * pose.probability / other;
  std::stable_sort(poses.begin(), poses.end(), [](const StablePose& a, const StablePose& b) { return a.probability > b.probability; });
  std::erase_if(poses, [&](const StablePose& pose) { return pose.probability < options.min_probability; });
  if (poses.size() > static_cast<std::size_t>(options.max_poses)) poses.resize(static_cast<std::size_t>(options.max_poses));
  double sum = 0;
  for (const auto& pose : poses) sum += pose.probability;
  for (auto& pose : poses) pose.probability /= sum;
  return poses;
}

}  // namespace gfp
