#include "grasp/soft_pair.hpp"

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <numbers>

#include "grasp/friction_cone.hpp"

namespace gfp {
namespace {

constexpr int kMaxFacets = 256;  // two bipyramids over polygons of 64 edges
constexpr double kFlat = 1e-9;   // a pivot below it: W has less than six dimensions

/// Halfspaces offset >= normal . w, before they are normalised; structure of arrays for the inner loop.
struct Halfspaces {
  int size = 0;
  alignas(32) double at_kernel[kMaxFacets];  // the facet's covector applied to k, in absolute value
  alignas(32) double row[7][kMaxFacets];     // 0..5 normal, 6 offset

  void add(double value, const Eigen::Matrix<double, 7, 1>& halfspace) {
    at_kernel[size] = std::abs(value);
    for (int i = 0; i < 7; ++i) row[i][size] = halfspace[i];
    ++size;
  }
};

/// Least of offset |offset| / |normal|^2 over the halfspaces in which facet (value, h) and each opposite facet cancel k.
/// Raw pointers only, so that both clones give the same bits.
__attribute__((target_clones("arch=x86-64-v3", "default")))
double nearest_squared(double value, const double* h, const double* values, const double (*rows)[kMaxFacets], int size) {
  double nearest = 1e300;
  for (int i = 0; i < size; ++i) {
    const double a = values[i], b = value;  // a * h + b * row vanishes on k
    double normal_squared = 1e-300;
    for (int d = 0; d < 6; ++d) {
      const double u = a * h[d] + b * rows[d][i];
      normal_squared += u * u;
    }
    const double offset = a * h[6] + b * rows[6][i];
    const double squared = offset * std::abs(offset) / normal_squared;
    nearest = squared < nearest ? squared : nearest;
  }
  return nearest;
}

}  // namespace

GraspQuality soft_pair_quality(const WrenchContact& first, const WrenchContact& second, const WrenchScale& scale, int cone_edges) {
  // Rows of S as columns: S^T = Q R, so that k is Q's last column and T = R^-1 Q^T turns a covector that vanishes on k into
  // its halfspace (-normal, offset).
  Eigen::Matrix<double, 8, 7> transposed;
  transposed.topLeftCorner<4, 6>() = contact_map(first, scale).wrench_of_local.transpose();
  transposed.bottomLeftCorner<4, 6>() = contact_map(second, scale).wrench_of_local.transpose();
  transposed.col(6) << 1, 0, 0, 0, 1, 0, 0, 0;
  const Eigen::HouseholderQR<Eigen::Matrix<double, 8, 7>> qr(transposed);
  const auto pivots = qr.matrixQR().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > kFlat)) return {};
  const Eigen::Matrix<double, 8, 8> q = qr.householderQ();
  const Eigen::Matrix<double, 8, 1> kernel = q.col(7);
  const Eigen::Matrix<double, 7, 8> to_halfspace =
      qr.matrixQR().topRows<7>().triangularView<Eigen::Upper>().solve(q.leftCols<7>().transpose());

  Halfspaces positive, negative;
  double positive_sum = 0;
  const PolygonSides sides = polygon_sides(cone_edges);
  for (int contact = 0; contact < 2; ++contact) {
    const Eigen::Vector4d k = kernel.segment<4>(4 * contact);
    const Eigen::Matrix<double, 7, 4> t = to_halfspace.middleCols<4>(4 * contact);
    for (std::size_t j = 0; j < static_cast<std::size_t>(cone_edges); ++j) {
      const double a = sides.a[j], b = sides.b[j];
      const double side = k[0] - a * k[1] - b * k[2];
      const Eigen::Matrix<double, 7, 1> side_halfspace = t.col(0) - a * t.col(1) - b * t.col(2);
      for (const double pole : {1.0, -1.0}) {
        const double value = side - pole * k[3];
        (value < 0 ? negative : positive).add(value, side_halfspace - pole * t.col(3));
        positive_sum += value > 0 ? value : 0;
      }
    }
  }

  double nearest = 1e300;
  for (int i = 0; i < positive.size; ++i) {
    std::array<double, 7> h;
    for (std::size_t d = 0; d < 7; ++d) h[d] = positive.row[d][i];
    nearest = std::min(nearest, nearest_squared(positive.at_kernel[i], h.data(), negative.at_kernel, negative.row, negative.size));
  }
  GraspQuality quality;
  quality.force_closure = negative.size > 0 && nearest > kFlat * kFlat;
  quality.epsilon = quality.force_closure ? std::sqrt(nearest) : 0;
  // A facet's join with the other cone covers vol(bipyramid)^2 / (40 E) * value of W, with k as long as S's maximal minors.
  const double bipyramid = 2.0 / 3.0 * 0.5 * cone_edges * std::sin(2 * std::numbers::pi / cone_edges);
  quality.volume = bipyramid * bipyramid / (40.0 * cone_edges) * pivots.prod() * positive_sum;
  return quality;
}

}  // namespace gfp
