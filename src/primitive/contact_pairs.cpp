#include "gfp/primitive/contact_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

const Eigen::Vector3d& corner(const TriangleMesh& mesh, std::size_t face, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[face][k])];
}

struct Hit {
  double distance_m = 0;
  Eigen::Vector3d barycentric;
};

/// Moller and Trumbore 1997.
std::optional<Hit> intersect(const TriangleMesh& mesh, std::size_t face, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& a = corner(mesh, face, 0);
  const Eigen::Vector3d ab = corner(mesh, face, 1) - a, ac = corner(mesh, face, 2) - a, p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return std::nullopt;
  const Eigen::Vector3d s = origin - a, q = s.cross(ab);
  const double u = s.dot(p) / determinant, v = direction.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
  return Hit{ac.dot(q) / determinant, {1 - u - v, u, v}};
}

std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
  std::vector<double> areas;
  double sum = 0;
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    sum += 0.5 * (corner(mesh, face, 1) - corner(mesh, face, 0)).cross(corner(mesh, face, 2) - corner(mesh, face, 0)).norm();
    areas.push_back(sum);
  }
  return areas;
}

}  // namespace

std::vector<ContactPair> sample_contact_pairs(const TriangleMesh& mesh, const ContactPairOptions& options) {
  Random random(options.seed);
  const auto areas = cumulative_areas(mesh);
  const auto normals = triangle_normals(mesh);
  std::vector<ContactPair> pairs;
  for (int ray = 0; ray < options.max_rays && static_cast<int>(pairs.size()) < options.pairs; ++ray) {
    const auto face = static_cast<std::size_t>(std::upper_bound(areas.begin(), areas.end(), random.uniform() * areas.back()) - areas.begin());
    const double root = std::sqrt(random.uniform()), share = random.uniform();
    if (face >= mesh.triangles.size() || normals[face].squaredNorm() == 0) continue;
    const Eigen::Vector3d barycentric(1 - root, root * (1 - share), root * share), direction = -normals[face];
    const Eigen::Vector3d origin = barycentric[0] * corner(mesh, face, 0) + barycentric[1] * corner(mesh, face, 1) + barycentric[2] * corner(mesh, face, 2);
    for (std::size_t other = 0; other < mesh.triangles.size(); ++other) {
      if (other == face || normals[other].dot(direction) < std::cos(options.cone_rad)) continue;
      const auto hit = intersect(mesh, other, origin, direction);
      if (!hit || hit->distance_m < options.min_width_m || hit->distance_m > options.max_width_m) continue;
      pairs.push_back({{static_cast<std::int32_t>(face), static_cast<std::int32_t>(other)}, {barycentric, hit->barycentric}});
    }
  }
  if (pairs.size() > static_cast<std::size_t>(options.pairs)) pairs.resize(static_cast<std::size_t>(options.pairs));
  return pairs;
}

}  // namespace gfp
