#include "collection/morph.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gfp/core/self_intersections.hpp"
#include "gfp/evaluation/surface_samples.hpp"
#include "gfp/modelling/contour_solver.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A stretch of the morph: how stiff the surface is, and how far it looks.
struct Stretch {
  double membrane, plate;
  int steps;
  double gate_share;  ///< Of the longest side.
};
constexpr Stretch kStretches[] = {{30, 300, 20, 0.25}, {6, 60, 20, 0.12}, {1.5, 12, 20, 0.06}, {0.4, 3, 15, 0.03}};
constexpr double kLeastAgreement = 0.3;  ///< Cosine between the normals: else another side of a thin wall.

std::vector<Vector3d> scaled_to(const std::vector<Vector3d>& points, const Bounds& box) {
  const Bounds own = bounds(points);
  const Vector3d scale = box.size().cwiseQuotient(own.size().cwiseMax(1e-9));
  std::vector<Vector3d> moved;
  for (const Vector3d& p : points) moved.push_back(box.low + scale.cwiseProduct(p - own.low));
  return moved;
}

}  // namespace

std::vector<Vector3d> morph(const TriangleMesh& shape, const TriangleMesh& onto, const TriangleTree& onto_tree) {
  Topology topology;
  topology.triangles = shape.triangles;
  const Bounds box = bounds(onto.vertices);
  const double longest = box.size().maxCoeff();
  const std::vector<Vector3d> normals_onto = triangle_normals(onto);
  /// How far the vertex is from what it should lie on: the nearest place, if that faces its way; else what it meets along its normal that does,
  /// since the nearest place of a thin wall may be its other side.
  const auto distance_along = [&](const Vector3d& vertex, const Vector3d& normal, double reach) -> std::optional<double> {
    const auto nearest = onto_tree.closest(vertex, reach);
    if (nearest.triangle >= 0 && normals_onto[static_cast<std::size_t>(nearest.triangle)].dot(normal) >= kLeastAgreement) return normal.dot(nearest.point - vertex);
    return onto_tree.crossing_along(vertex, normal, reach);
  };
  std::vector<Vector3d> best = scaled_to(shape.vertices, box);
  for (const Stretch& stretch : kStretches) {
    const ContourSolver solver(topology, shape.vertices.size(), stretch.membrane, stretch.plate);
    const std::vector<Vector3d> rest = best;
    TriangleMesh now{rest, shape.triangles};
    Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(rest.size()), 3);
    for (int step = 0; step < stretch.steps; ++step) {
      const auto normals = vertex_normals(now);
      std::vector<double> targets(rest.size(), 0.0), weights(rest.size(), 0.0);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const std::optional<double> ahead = distance_along(now.vertices[i], normals[i], stretch.gate_share * longest);
        if (!ahead) continue;
        targets[i] = *ahead + normals[i].dot(u.row(static_cast<Eigen::Index>(i)).transpose());
        weights[i] = 1;
      }
      u = solver.step(u, normals, targets, weights);
      for (std::size_t i = 0; i < rest.size(); ++i) now.vertices[i] = rest[i] + u.row(static_cast<Eigen::Index>(i)).transpose();
    }
    best = approach_without_crossing(best, now.vertices, shape.triangles).vertices;
  }
  return best;
}

double surface_distance_m(const TriangleMesh& a, const TriangleTree& a_tree, const TriangleMesh& b, const TriangleTree& b_tree, int samples) {
  const auto mean = [&](const TriangleMesh& from, const TriangleTree& to) {
    double sum = 0;
    const SurfaceSamples points = sample_surface(from, samples, 1);
    for (const Vector3d& p : points.points) sum += to.closest(p).distance_m;
    return sum / static_cast<double>(std::max<std::size_t>(1, points.points.size()));
  };
  return 0.5 * (mean(a, b_tree) + mean(b, a_tree));
}

}  // namespace gfp
