#include "modelling/contour_solver.hpp"

#include <map>
#include <mutex>
#include <tuple>

#include "gfp/core/mesh.hpp"

namespace gfp {
namespace {

Eigen::SparseMatrix<double> graph_laplacian(const Topology& topology, std::size_t vertices) {
  TriangleMesh connectivity;
  connectivity.vertices.resize(vertices);
  connectivity.triangles = topology.triangles;
  const VertexAdjacency adjacency = vertex_adjacency(connectivity);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < vertices; ++i) {
    const auto degree = adjacency.offsets[i + 1] - adjacency.offsets[i];
    if (degree == 0) continue;
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
    for (auto k = adjacency.offsets[i]; k < adjacency.offsets[i + 1]; ++k)
      entries.emplace_back(static_cast<int>(i), adjacency.indices[static_cast<std::size_t>(k)], -1.0 / degree);
  }
  const auto size = static_cast<Eigen::Index>(vertices);
  Eigen::SparseMatrix<double> laplacian(size, size);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

Eigen::SparseMatrix<double> identity(Eigen::Index size) {
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setIdentity();
  return matrix;
}

}  // namespace

ContourSolver::ContourSolver(const Topology& topology, std::size_t vertices, double membrane_weight, double plate_weight)
    : membrane_weight_(membrane_weight), plate_weight_(plate_weight), laplacian_(graph_laplacian(topology, vertices)) {
  // Degrees differ from vertex to vertex, so the membrane term is the symmetric part of the normalised Laplacian.
  const Eigen::SparseMatrix<double> transposed = laplacian_.transpose();
  const Eigen::SparseMatrix<double> membrane = 0.5 * (laplacian_ + transposed);
  const Eigen::SparseMatrix<double> plate = transposed * laplacian_;
  factor_.compute(identity(laplacian_.rows()) + membrane_weight_ * membrane + plate_weight_ * plate);
}

Eigen::MatrixX3d ContourSolver::step(const Eigen::MatrixX3d& u, const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& targets,
                                     const std::vector<double>& weights) const {
  Eigen::MatrixX3d right = u;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (weights[i] <= 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    const double residual = normals[i].dot(u.row(row).transpose()) - targets[i];
    right.row(row) -= (weights[i] * residual) * normals[i].transpose();
  }
  return factor_.solve(right);
}

double ContourSolver::energy(const Eigen::MatrixX3d& u, const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& targets,
                             const std::vector<double>& weights) const {
  const Eigen::MatrixX3d curvature = laplacian_ * u;
  double energy = membrane_weight_ * (u.array() * curvature.array()).sum() + plate_weight_ * curvature.squaredNorm();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double residual = normals[i].dot(u.row(static_cast<Eigen::Index>(i)).transpose()) - targets[i];
    energy += weights[i] * residual * residual;
  }
  return energy;
}

std::shared_ptr<const ContourSolver> contour_solver(const Primitive& primitive, const ModellingOptions& options) {
  static std::mutex mutex;
  static std::map<std::tuple<std::uint64_t, std::size_t, double, double>, std::shared_ptr<const ContourSolver>> solvers;
  const auto key = std::make_tuple(primitive.topology->hash, primitive.size(), options.membrane_weight, options.plate_weight);
  const std::lock_guard lock(mutex);
  auto& solver = solvers[key];
  if (!solver) solver = std::make_shared<const ContourSolver>(*primitive.topology, primitive.size(), options.membrane_weight, options.plate_weight);
  return solver;
}

}  // namespace gfp
