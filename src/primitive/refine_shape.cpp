#include <map>
#include <numbers>

#include "primitive/curves.hpp"
#include "primitive/family_shape.hpp"

namespace gfp {
namespace {

/// Where a curved patch with these corner normals passes between two vertices (Vlachos et al. 2001, cubic edge at 1/2).
Eigen::Vector3d curved_midpoint(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& normal_p, const Eigen::Vector3d& normal_q) {
  const Eigen::Vector3d edge = q - p;
  return 0.5 * (p + q) - 0.125 * (edge.dot(normal_p) * normal_p - edge.dot(normal_q) * normal_q);
}

/// Vertex normals, zero where the surface has an edge: there the new vertices stay on the straight line.
std::vector<Eigen::Vector3d> smooth_normals(const TriangleMesh& mesh) {
  constexpr double kSmooth = 0.8;  // cosine between a vertex's normal and its triangles'
  const auto faces = triangle_normals(mesh);
  const auto all = vertex_normals(mesh);
  auto normals = all;
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (const auto v : mesh.triangles[t])
      if (faces[t].dot(all[static_cast<std::size_t>(v)]) < kSmooth) normals[static_cast<std::size_t>(v)].setZero();
  return normals;
}

class Splitter {
 public:
  explicit Splitter(FamilyShape& shape) : shape_(shape), normals_(smooth_normals(shape.mesh)) {}

  std::int32_t midpoint(std::int32_t a, std::int32_t b) {
    const auto [entry, fresh] = midpoints_.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(shape_.mesh.vertices.size()));
    if (fresh) {
      const auto i = static_cast<std::size_t>(std::min(a, b)), j = static_cast<std::size_t>(std::max(a, b));
      shape_.mesh.vertices.push_back(curved_midpoint(shape_.mesh.vertices[i], shape_.mesh.vertices[j], normals_[i], normals_[j]));
      shape_.parts.push_back(shape_.parts[i] == shape_.parts[j] ? shape_.parts[i] : std::max(shape_.parts[i], shape_.parts[j]));
    }
    return entry->second;
  }

 private:
  FamilyShape& shape_;
  std::vector<Eigen::Vector3d> normals_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> midpoints_;
};

void refine_once(FamilyShape& shape) {
  Splitter splitter(shape);
  std::vector<Triangle> triangles;
  std::vector<bool> filled;
  for (std::size_t t = 0; t < shape.mesh.triangles.size(); ++t) {
    const auto [a, b, c] = shape.mesh.triangles[t];
    const auto ab = splitter.midpoint(a, b), bc = splitter.midpoint(b, c), ca = splitter.midpoint(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    filled.insert(filled.end(), 4, shape.filled[t]);
  }
  std::vector<std::int32_t> lid;
  for (std::size_t i = 0; i < shape.lid.size(); ++i) {
    lid.push_back(shape.lid[i]);
    lid.push_back(splitter.midpoint(shape.lid[i], shape.lid[(i + 1) % shape.lid.size()]));
  }
  shape.mesh.triangles = std::move(triangles);
  shape.filled = std::move(filled);
  shape.lid = std::move(lid);
}

}  // namespace

void refine(FamilyShape& shape, int levels) {
  for (int level = 0; level < levels; ++level) refine_once(shape);
}

void bend_freely(FamilyShape& shape, double amplitude, Random& random) {
  const Bounds box = bounds(shape.mesh.vertices);
  const double extent = box.size().maxCoeff();
  // A few plane waves, at most 1.2 periods over the object. Their slopes add up to less than 1: the map stays one-to-one.
  constexpr int kWaves = 4;
  constexpr double kMaxAmplitude = 0.08;
  struct Wave {
    Eigen::Vector3d direction, displacement;
    double phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d displacement(random.normal(), random.normal(), random.normal());
    const double periods = random.uniform(0.5, 1.2), phase = random.uniform(0, 2 * std::numbers::pi);
    waves.push_back({2 * std::numbers::pi * periods / extent * direction.normalized(),
                     std::min(amplitude, kMaxAmplitude) * extent / kWaves * displacement.normalized(), phase});
  }
  for (auto& p : shape.mesh.vertices) {
    Eigen::Vector3d moved = p;
    const double lift = (p.z() - box.low.z()) / extent;  // the base stays flat on the table
    for (const auto& wave : waves) {
      const Eigen::Vector3d step = std::sin(wave.direction.dot(p) + wave.phase) * wave.displacement;
      moved += Eigen::Vector3d(step.x(), step.y(), lift * step.z());
    }
    p = moved;
  }
}

std::vector<Triangle> filled_triangles(const FamilyShape& shape) {
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < shape.mesh.triangles.size(); ++t)
    if (shape.filled[t]) triangles.push_back(shape.mesh.triangles[t]);
  // The lid: chords across the loop between mirrored vertices.
  const std::size_t n = shape.lid.size();
  for (std::size_t i = 0; 2 * i + 2 <= n; ++i) {
    const auto near = shape.lid[i], near_next = shape.lid[i + 1], far = shape.lid[(n - i) % n], far_next = shape.lid[n - 1 - i];
    if (i > 0) triangles.push_back({near, near_next, far});
    if (near_next != far_next) triangles.push_back({far, near_next, far_next});
  }
  return triangles;
}

}  // namespace gfp
