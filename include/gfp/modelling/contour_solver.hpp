#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "gfp/modelling/model_contour.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The semi-implicit step of the contour (ALGORITHM 2): minimises
///     sum_i w_i (n_i . u_i - d_i)^2 + lc |grad u|^2 + lb |laplace u|^2
/// over displacements u from the rest shape. The data term is majorised by |u|^2 with weight 1, so the matrix
/// 1 + lc K + lb K^2 (K: graph Laplacian of the primitive's connectivity) is the same for every object and iteration of a class.
class ContourSolver {
 public:
  ContourSolver(const Topology& topology, std::size_t vertices, double membrane_weight, double plate_weight);

  /// One step from `u` (N x 3, metres): normals unit, targets along them in metres, weights in [0, 1].
  Eigen::MatrixX3d step(const Eigen::MatrixX3d& u, const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& targets,
                        const std::vector<double>& weights) const;

  /// The energy that the steps minimise, m^2.
  double energy(const Eigen::MatrixX3d& u, const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& targets,
                const std::vector<double>& weights) const;

 private:
  double membrane_weight_, plate_weight_;
  Eigen::SparseMatrix<double> laplacian_;
  Eigen::SparseMatrix<double> lower_;  ///< L D L^T = P matrix P^T; L without its unit diagonal.
  Eigen::VectorXd inverse_diagonal_;
  Eigen::VectorXi place_;              ///< P: where in the factor each vertex is.
};

/// The solver of a primitive, factored on first use and kept for the process. Safe from any thread.
std::shared_ptr<const ContourSolver> contour_solver(const Primitive& primitive, const ModellingOptions& options);

}  // namespace gfp
