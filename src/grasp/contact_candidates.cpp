#include "grasp/contact_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/random.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest = 2.0;      // metres: no household object is wider
constexpr double kLeastWidth = 2e-4;   // metres: thinner is a ray along an edge, not a wall

/// Share of the friction cone that a unit force along `inward_force` takes at a contact with this outward normal.
double cone_use(const Vector3d& inward_force, const Vector3d& normal_outward, double friction) {
  const double along = -inward_force.dot(normal_outward);
  if (along <= 0) return 1e9;
  return std::sqrt(std::max(0.0, 1 - along * along)) / (along * friction);
}

class Search {
 public:
  Search(double friction, double narrowest_m, double widest_m) : friction_(friction), narrowest_m_(narrowest_m), widest_m_(widest_m) {}

  void consider(const Vector3d& p, const Vector3d& normal_p, const Vector3d& q, const Vector3d& normal_q) {
    const double width = (q - p).norm();
    if (!(width > kLeastWidth)) return;
    const Vector3d along = (q - p) / width;
    const double use = std::max(cone_use(along, normal_p, friction_), cone_use(-along, normal_q, friction_));
    if (use > kMostUse || width < narrowest_m_) return;
    (width > widest_m_ ? found.too_wide : found.pairs).push_back({p, q, width, use});
  }

  PairSearch found;

 private:
  static constexpr double kMostUse = 0.9;  // an octagonal cone reaches cos(pi / 8) = 0.92 of the round one

  double friction_, narrowest_m_, widest_m_;
};

Vector3d corner(const TriangleMesh& mesh, std::int32_t triangle, int i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(i)])];
}

Vector3d carried(const TriangleMesh& mesh, std::int32_t triangle, const Vector3d& barycentric) {
  return barycentric[0] * corner(mesh, triangle, 0) + barycentric[1] * corner(mesh, triangle, 1) + barycentric[2] * corner(mesh, triangle, 2);
}

std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto i = static_cast<std::int32_t>(t);
    sum += 0.5 * (corner(mesh, i, 1) - corner(mesh, i, 0)).cross(corner(mesh, i, 2) - corner(mesh, i, 0)).norm();
    sums.push_back(sum);
  }
  return sums;
}

/// Uniform in the cap of half-angle atan(tangent) about `axis`.
Vector3d tilted(const Vector3d& axis, double tangent, Random& random) {
  const auto [t1, t2] = orthonormal_basis(axis);
  const double reach = tangent * std::sqrt(random.uniform()), angle = 2 * std::numbers::pi * random.uniform();
  return (axis + reach * (std::cos(angle) * t1 + std::sin(angle) * t2)).normalized();
}

}  // namespace

PairSearch find_antipodal_pairs(const FittedModel& model, const TriangleMesh& mesh_camera, const std::vector<Vector3d>& normals,
                                const TriangleBvh& bvh, double friction, double narrowest_m, double widest_m,
                                const PlanGraspsOptions& options) {
  Search search(friction, narrowest_m, widest_m);
  const auto normal = [&](std::int32_t triangle) -> const Vector3d& { return normals[static_cast<std::size_t>(triangle)]; };
  if (model.primitive && model.primitive->topology == model.topology)
    for (const ContactPair& pair : model.primitive->contact_pairs)
      search.consider(carried(mesh_camera, pair.face[0], pair.barycentric[0]), normal(pair.face[0]),
                      carried(mesh_camera, pair.face[1], pair.barycentric[1]), normal(pair.face[1]));

  const std::vector<double> areas = cumulative_areas(mesh_camera);
  if (areas.empty() || !(areas.back() > 0)) return search.found;
  Random random(options.seed);
  std::vector<Crossing> crossings;
  for (int s = 0; s < options.samples; ++s) {
    const auto place = std::upper_bound(areas.begin(), areas.end(), random.uniform() * areas.back());
    const auto triangle = static_cast<std::int32_t>(std::min(place - areas.begin(), static_cast<std::ptrdiff_t>(areas.size()) - 1));
    const double r = std::sqrt(random.uniform()), v = random.uniform();  // uniform on the triangle (Osada et al. 2002)
    const Vector3d p = carried(mesh_camera, triangle, {1 - r, r * (1 - v), r * v});
    const Vector3d inward = -normal(triangle);
    for (const Vector3d& along : {inward, tilted(inward, 0.8 * friction, random)}) {
      bvh.crossings(p, along, kFarthest, crossings);
      for (const Crossing& crossing : crossings)
        if (!crossing.entering && crossing.triangle != triangle)
          search.consider(p, normal(triangle), p + crossing.distance_m * along, normal(crossing.triangle));
    }
  }
  return search.found;
}

}  // namespace gfp
