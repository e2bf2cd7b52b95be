#include "primitive/shape_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kSizeFloor = 1e-4;       ///< Variance of log size that no class goes below: 1 %.
constexpr double kResidualFloor = 0.004;  ///< Even an exact family meets objects it does not contain; canonical units.
constexpr double kNegligible = 1e-6;      ///< Share of the variance below which a mode is noise.

}  // namespace

void average_shapes(const std::vector<std::vector<Eigen::Vector3d>>& members, int max_modes, Primitive& primitive) {
  const auto points = static_cast<Eigen::Index>(members.front().size()), count = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd deviations(3 * points, count);
  for (Eigen::Index m = 0; m < count; ++m)
    for (Eigen::Index i = 0; i < points; ++i) deviations.col(m).segment<3>(3 * i) = members[static_cast<std::size_t>(m)][static_cast<std::size_t>(i)];
  const Eigen::VectorXd mean = deviations.rowwise().mean();
  deviations.colwise() -= mean;
  primitive.mean.clear();
  for (Eigen::Index i = 0; i < points; ++i) primitive.mean.emplace_back(mean.segment<3>(3 * i));

  // Members are far fewer than coordinates: the M x M Gram matrix has the same non-zero spectrum as the covariance.
  const double degrees = static_cast<double>(std::max<Eigen::Index>(1, count - 1));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(deviations.transpose() * deviations / degrees);
  const double total = spectrum.eigenvalues().sum();
  double kept = 0;
  primitive.modes.clear();
  primitive.mode_sigma.clear();
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(max_modes, count - 1); ++k) {
    const Eigen::Index column = count - 1 - k;
    if (spectrum.eigenvalues()[column] < kNegligible * total) break;
    kept += spectrum.eigenvalues()[column];
    const Eigen::VectorXd mode = deviations * spectrum.eigenvectors().col(column) / std::sqrt(degrees);
    auto& vectors = primitive.modes.emplace_back();
    for (Eigen::Index i = 0; i < points; ++i) vectors.emplace_back(mode.segment<3>(3 * i));
    primitive.mode_sigma.push_back(mode.norm() / std::sqrt(static_cast<double>(points)));
  }
  primitive.residual_sigma = kResidualFloor + std::sqrt(std::max(0.0, total - kept) / static_cast<double>(3 * points));
}

void average_sizes(const std::vector<Eigen::Vector3d>& sizes_m, Primitive& primitive) {
  Eigen::Matrix3Xd logs(3, static_cast<Eigen::Index>(sizes_m.size()));
  for (std::size_t m = 0; m < sizes_m.size(); ++m) logs.col(static_cast<Eigen::Index>(m)) = sizes_m[m].array().log().matrix();
  primitive.log_size_mean = logs.rowwise().mean();
  logs.colwise() -= primitive.log_size_mean;
  primitive.log_size_covariance = logs * logs.transpose() / static_cast<double>(std::max<std::size_t>(1, sizes_m.size() - 1)) + kSizeFloor * Eigen::Matrix3d::Identity();
}

}  // namespace gfp
