#include "gfp/modelling/contour_solver.hpp"

#include <Eigen/SparseCholesky>
#include <cstddef>
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

constexpr std::size_t kLanes = 4;  ///< x, y, z and nothing: one row of the unknowns.

/// Solves L D L^T x = x in place for all columns at once; the factor is read once, not once a column.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void solve_rows(const int* first, const int* row, const double* value, const double* inverse_diagonal,
                                                                            int count, double* x) {
  using Row = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias, aligned(alignof(double))));
  auto* rows = reinterpret_cast<Row*>(x);
  for (int j = 0; j < count; ++j)
    for (int k = first[j]; k < first[j + 1]; ++k) rows[row[k]] -= value[k] * rows[j];
  for (int j = 0; j < count; ++j) rows[j] *= inverse_diagonal[j];
  for (int j = count - 1; j >= 0; --j) {
    Row sum = rows[j];
    for (int k = first[j]; k < first[j + 1]; ++k) sum -= value[k] * rows[row[k]];
    rows[j] = sum;
  }
}

}  // namespace

ContourSolver::ContourSolver(const Topology& topology, std::size_t vertices, double membrane_weight, double plate_weight)
    : membrane_weight_(membrane_weight), plate_weight_(plate_weight), laplacian_(graph_laplacian(topology, vertices)) {
  // Degrees differ from vertex to vertex, so the membrane term is the symmetric part of the normalised Laplacian.
  const Eigen::SparseMatrix<double> transposed = laplacian_.transpose();
  const Eigen::SparseMatrix<double> membrane = 0.5 * (laplacian_ + transposed);
  const Eigen::SparseMatrix<double> plate = transposed * laplacian_;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factorisation(identity(laplacian_.rows()) + membrane_weight_ * membrane + plate_weight_ * plate);
  lower_ = factorisation.matrixL().nestedExpression();  // strictly lower: the unit diagonal is not stored
  lower_.makeCompressed();
  inverse_diagonal_ = factorisation.vectorD().cwiseInverse();
  place_ = factorisation.permutationP().indices();
}

Eigen::MatrixX3d ContourSolver::step(const Eigen::MatrixX3d& u, const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& targets,
                                     const std::vector<double>& weights) const {
  const std::size_t count = normals.size();
  std::vector<double> rows(kLanes * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double pull = weights[i] > 0 ? weights[i] * (normals[i].dot(u.row(row).transpose()) - targets[i]) : 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      rows[kLanes * static_cast<std::size_t>(place_[row]) + k] = u(row, static_cast<Eigen::Index>(k)) - pull * normals[i][static_cast<Eigen::Index>(k)];
  }
  solve_rows(lower_.outerIndexPtr(), lower_.innerIndexPtr(), lower_.valuePtr(), inverse_diagonal_.data(), static_cast<int>(count), rows.data());
  Eigen::MatrixX3d next(u.rows(), 3);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) next(i, k) = rows[kLanes * static_cast<std::size_t>(place_[i]) + static_cast<std::size_t>(k)];
  return next;
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
