#include "gfp/grasp/wrench_space.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "grasp/friction_cone.hpp"
#include "grasp/soft_pair.hpp"
#include "grasp/wrench_hull.hpp"

namespace gfp {

WrenchScale wrench_scale(const TriangleMesh& mesh) {
  WrenchScale scale{volume_centroid(mesh), 0};
  for (const Eigen::Vector3d& vertex : mesh.vertices) scale.radius_m = std::max(scale.radius_m, (vertex - scale.centre).norm());
  return scale;
}

std::vector<Wrench> primitive_wrenches(std::span<const WrenchContact> contacts, const WrenchScale& scale, const WrenchSpaceOptions& options) {
  std::vector<Wrench> wrenches;
  for (const WrenchContact& contact : contacts) {
    const ContactMap map = contact_map(contact, scale);
    for (int j = 0; j < options.cone_edges; ++j) {
      const double angle = 2 * std::numbers::pi * j / options.cone_edges;
      wrenches.push_back(map.wrench_of_local * Eigen::Vector4d(1, std::cos(angle), std::sin(angle), 0));
    }
    if (!map.soft) continue;
    wrenches.push_back(map.wrench_of_local * Eigen::Vector4d(1, 0, 0, 1));
    wrenches.push_back(map.wrench_of_local * Eigen::Vector4d(1, 0, 0, -1));
  }
  return wrenches;
}

GraspQuality grasp_quality(std::span<const WrenchContact> contacts, const WrenchScale& scale, const WrenchSpaceOptions& options) {
  assert(scale.radius_m > 0 && 3 <= options.cone_edges && options.cone_edges <= 64);
  if (contacts.size() < 2) return {};
  if (contacts.size() == 2 && contacts[0].torsion_m > 0 && contacts[1].torsion_m > 0)
    return soft_pair_quality(contacts[0], contacts[1], scale, options.cone_edges);
  return wrench_hull_quality(primitive_wrenches(contacts, scale, options), options.volume);
}

double epsilon_lower_bound(std::span<const WrenchContact> contacts, const WrenchScale& scale, const WrenchSpaceOptions& options) {
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  using Matrix74d = Eigen::Matrix<double, 7, 4>;
  std::vector<Matrix74d> maps;  // the wrench and the sum of normal forces that a contact's coordinates make
  std::vector<bool> soft;
  Eigen::Matrix<double, 7, 7> normal_matrix = Eigen::Matrix<double, 7, 7>::Zero();
  for (const WrenchContact& contact : contacts) {
    const ContactMap map = contact_map(contact, scale);
    Matrix74d m;
    m << map.wrench_of_local, Eigen::RowVector4d(1, 0, 0, 0);
    maps.push_back(m);
    soft.push_back(map.soft);
    normal_matrix.noalias() += m * m.transpose();
  }
  const Eigen::LLT<Eigen::Matrix<double, 7, 7>> factor(normal_matrix);
  const auto pivots = factor.matrixLLT().diagonal();
  if (contacts.empty() || factor.info() != Eigen::Success || !(pivots.minCoeff() > 1e-7)) return 0;  // W may be flat

  // Internal force: equal shares, corrected by least squares to balance: x = x_mean - M^T (M M^T)^-1 (M x_mean - (0, 1)).
  Vector7d imbalance = -Vector7d::Unit(6);
  for (const Matrix74d& m : maps) imbalance += m.col(0) / static_cast<double>(maps.size());
  const Vector7d correction = factor.solve(imbalance);
  const Eigen::Matrix<double, 7, 7> inverse = factor.solve(Eigen::Matrix<double, 7, 7>::Identity());

  double bound = 1e300;
  const PolygonSides sides = polygon_sides(options.cone_edges);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const Eigen::Vector4d internal = Eigen::Vector4d::Unit(0) / static_cast<double>(maps.size()) - maps[i].transpose() * correction;
    const Eigen::Matrix<double, 4, 6> response = maps[i].transpose() * inverse.leftCols<6>();
    const Eigen::Matrix4d spread = response * response.transpose();
    for (std::size_t j = 0; j < static_cast<std::size_t>(options.cone_edges); ++j) {
      for (const double pole : {1.0, -1.0}) {
        const Eigen::Vector4d facet(1, -sides.a[j], -sides.b[j], soft[i] ? pole : 0);
        bound = std::min(bound, facet.dot(internal) / std::sqrt(facet.dot(spread * facet)));
      }
    }
  }
  return std::max(0.0, bound);
}

}  // namespace gfp
