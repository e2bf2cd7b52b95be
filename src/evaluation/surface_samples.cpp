#include "gfp/evaluation/surface_samples.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"

namespace gfp {

SurfaceSamples sample_surface(const TriangleMesh& mesh, int count, std::uint64_t seed) {
  const auto corner = [&](std::int32_t i) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(i)]; };
  std::vector<double> area_to;  // cumulated up to and with each triangle
  area_to.reserve(mesh.triangles.size());
  double total = 0;
  for (const Triangle& t : mesh.triangles)
    area_to.push_back(total += 0.5 * (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).norm());
  SurfaceSamples samples;
  if (!(total > 0) || !std::isfinite(total)) return samples;
  samples.points.reserve(static_cast<std::size_t>(count));
  samples.normals.reserve(static_cast<std::size_t>(count));
  Random random(seed);
  std::size_t triangle = 0;
  for (int i = 0; i < count; ++i) {
    const double area = total * (i + random.uniform()) / count;
    while (triangle + 1 < area_to.size() && area_to[triangle] <= area) ++triangle;
    const Triangle& t = mesh.triangles[triangle];
    const Eigen::Vector3d a = corner(t[0]), ab = corner(t[1]) - a, ac = corner(t[2]) - a;
    const double root = std::sqrt(random.uniform()), v = random.uniform();  // uniform over the triangle
    samples.points.push_back(a + root * ((1 - v) * ab + v * ac));
    samples.normals.push_back(ab.cross(ac).normalized());
  }
  return samples;
}

}  // namespace gfp
