#include "grasp/soft_pair.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "grasp/friction_cone.hpp"

namespace gfp {
namespace {

#define GFP_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))

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
GFP_CLONES double nearest_squared(double value, const double* h, const double* values, const double (*rows)[kMaxFacets], int size) {
  double squared[kMaxFacets];
  for (int i = 0; i < size; ++i) {
    const double a = values[i], b = value;  // a * h + b * row vanishes on k
    double normal_squared = 1e-300;
    for (int d = 0; d < 6; ++d) {
      const double u = a * h[d] + b * rows[d][i];
      normal_squared += u * u;
    }
    const double offset = a * h[6] + b * rows[6][i];
    squared[i] = offset * (offset < 0 ? -offset : offset) / normal_squared;
  }
  double nearest = 1e300;
  for (int i = 0; i < size; ++i) nearest = squared[i] < nearest ? squared[i] : nearest;
  return nearest;
}

/// Householder's QR of the left 7 of 16 columns (8 rows, row-major); the other columns are carried along. An identity there
/// becomes Q^T. Returns the product of the pivots, 0 where one is below kFlat.
GFP_CLONES double triangularise(double (*rows)[16]) {
  double product = 1;
  for (int p = 0; p < 7; ++p) {
    double squared = 0;
    for (int r = p; r < 8; ++r) squared += rows[r][p] * rows[r][p];
    const double length = __builtin_sqrt(squared);
    if (!(length > kFlat)) return 0;
    product *= length;
    const double pivot = rows[p][p] > 0 ? -length : length;
    double reflector[8];
    for (int r = p; r < 8; ++r) reflector[r] = rows[r][p];
    reflector[p] -= pivot;
    const double scale = 1.0 / (length * (length + (rows[p][p] < 0 ? -rows[p][p] : rows[p][p])));  // 2 / |reflector|^2
    double shares[16] = {};
    for (int r = p; r < 8; ++r)
      for (int c = 0; c < 16; ++c) shares[c] += reflector[r] * rows[r][c];
    for (int r = p; r < 8; ++r)
      for (int c = 0; c < 16; ++c) rows[r][c] -= scale * reflector[r] * shares[c];
  }
  return product;
}

/// Back substitution in place: columns 7 to 14 of rows 0 to 6 become R^-1 times themselves.
GFP_CLONES void substitute_back(double (*rows)[16]) {
  for (int r = 6; r >= 0; --r) {
    for (int below = r + 1; below < 7; ++below)
      for (int c = 7; c < 15; ++c) rows[r][c] -= rows[r][below] * rows[below][c];
    const double inverse = 1.0 / rows[r][r];
    for (int c = 7; c < 15; ++c) rows[r][c] *= inverse;
  }
}

}  // namespace

GraspQuality soft_pair_quality(const WrenchContact& first, const WrenchContact& second, const WrenchScale& scale, int cone_edges) {
  // [S^T | I], S^T = Q R, becomes [R | Q^T]: k is Q^T's last row, and T = R^-1 Q^T turns a covector that vanishes on k into
  // its halfspace (-normal, offset).
  alignas(32) double rows[8][16] = {};
  const ContactMap maps[2] = {contact_map(first, scale), contact_map(second, scale)};
  for (int r = 0; r < 8; ++r) {
    for (int d = 0; d < 6; ++d) rows[r][d] = maps[r / 4].wrench_of_local(d, r % 4);
    rows[r][6] = r % 4 == 0 ? 1 : 0;
    rows[r][7 + r] = 1;
  }
  const double pivots = triangularise(rows);
  if (!(pivots > 0)) return {};
  substitute_back(rows);
  const auto kernel = Eigen::Map<const Eigen::Matrix<double, 8, 1>>(&rows[7][7]);
  const auto to_halfspace = Eigen::Map<const Eigen::Matrix<double, 7, 8, Eigen::RowMajor>, 0, Eigen::OuterStride<16>>(&rows[0][7]);

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
  quality.volume = bipyramid * bipyramid / (40.0 * cone_edges) * pivots * positive_sum;
  return quality;
}

}  // namespace gfp
