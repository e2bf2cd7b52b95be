#include <Eigen/Dense>
#include <list>

#include "gfp/core/mesh.hpp"

// Smallest enclosing sphere: Welzl's recursion in its move-to-front form on the points, with the support set (at most four
// points on the boundary) solved by a small least-squares system.

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kRelativeSlack = 1e-12;

/// The smallest sphere through all of `support` (affinely independent, at most 4).
Sphere sphere_through(const std::vector<Vector3d>& support) {
  if (support.empty()) return {Vector3d::Zero(), -1};
  const auto rows = static_cast<Eigen::Index>(support.size()) - 1;
  if (rows == 0) return {support[0], 0};
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, rows);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> half_squares(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    edges.col(k) = support[static_cast<std::size_t>(k) + 1] - support[0];
    half_squares(k) = 0.5 * edges.col(k).squaredNorm();
  }
  // The centre lies in the span of the edges: (E^T E) w = |e|^2 / 2.
  const Vector3d offset = edges * (edges.transpose() * edges).ldlt().solve(half_squares);
  return {support[0] + offset, offset.norm()};
}

bool inside(const Sphere& sphere, const Vector3d& p) {
  return sphere.radius >= 0 && (p - sphere.centre).squaredNorm() <= sphere.radius * sphere.radius * (1 + kRelativeSlack) + 1e-300;
}

bool independent(const std::vector<Vector3d>& support, const Vector3d& p) {
  if (support.empty()) return true;
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (std::size_t k = 1; k < support.size(); ++k) edges.col(static_cast<Eigen::Index>(k) - 1) = support[k] - support[0];
  edges.col(static_cast<Eigen::Index>(support.size()) - 1) = p - support[0];
  const auto columns = static_cast<Eigen::Index>(support.size());
  return edges.leftCols(columns).colPivHouseholderQr().rank() == columns;
}

Sphere enclose(std::list<Vector3d>& points, std::list<Vector3d>::iterator end, std::vector<Vector3d>& support) {
  Sphere sphere = sphere_through(support);
  if (support.size() == 4) return sphere;
  for (auto it = points.begin(); it != end;) {
    const auto next = std::next(it);
    if (!inside(sphere, *it) && independent(support, *it)) {
      support.push_back(*it);
      sphere = enclose(points, it, support);
      support.pop_back();
      points.splice(points.begin(), points, it);
    }
    it = next;
  }
  return sphere;
}

}  // namespace

Sphere circumscribed_sphere(const std::vector<Vector3d>& points) {
  if (points.empty()) return {};
  std::list<Vector3d> queue(points.begin(), points.end());
  std::vector<Vector3d> support;
  return enclose(queue, queue.end(), support);
}

}  // namespace gfp
