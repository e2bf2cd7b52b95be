#include "modelling/symmetry_carry.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kSameRing = 0.004;    ///< Canonical units: ring mates agree to rounding in families, to this in averaged classes.
constexpr double kMirrorPartner = 0.02;///< Canonical units.

/// Weighted mean target of a group of counterparts.
struct Pool {
  double weighted_sum = 0, weight = 0;
  void include(double target, double w) { weighted_sum += w * target; weight += w; }
};

using CellKey = std::tuple<int, int, int, int>;

CellKey cell_of(const Vector3d& p, Part part, double size) {
  return {static_cast<int>(part), static_cast<int>(std::lround(p.x() / size)), static_cast<int>(std::lround(p.y() / size)), static_cast<int>(std::lround(p.z() / size))};
}

void carry_around(const Primitive& primitive, const SurfaceTargets& seen, double weight, SurfaceTargets& targets) {
  const auto ring_of = [&](std::size_t i) {
    const Vector3d& p = primitive.mean[i];
    return cell_of({std::hypot(p.x(), p.y()), 0, p.z()}, primitive.topology->parts[i], kSameRing);
  };
  std::map<CellKey, Pool> rings;
  for (std::size_t i = 0; i < primitive.size(); ++i)
    if (seen.weight[i] > 0) rings[ring_of(i)].include(seen.distance_m[i], seen.weight[i]);
  for (std::size_t i = 0; i < primitive.size(); ++i) {
    if (seen.weight[i] > 0) continue;
    const auto ring = rings.find(ring_of(i));
    if (ring == rings.end()) continue;
    targets.distance_m[i] = ring->second.weighted_sum / ring->second.weight;
    targets.weight[i] = weight * std::min(1.0, ring->second.weight);
  }
}

void carry_across(const Primitive& primitive, const Vector3d& mirror, const SurfaceTargets& seen, double weight, SurfaceTargets& targets) {
  std::map<CellKey, std::size_t> where;
  for (std::size_t i = 0; i < primitive.size(); ++i)
    if (seen.weight[i] > 0) where.emplace(cell_of(primitive.mean[i], primitive.topology->parts[i], kMirrorPartner), i);
  for (std::size_t i = 0; i < primitive.size(); ++i) {
    if (seen.weight[i] > 0 || targets.weight[i] > 0) continue;
    const auto partner = where.find(cell_of(primitive.mean[i].cwiseProduct(mirror), primitive.topology->parts[i], kMirrorPartner));
    if (partner == where.end()) continue;
    targets.distance_m[i] = seen.distance_m[partner->second];
    targets.weight[i] = weight * seen.weight[partner->second];
  }
}

}  // namespace

void carry_by_symmetry(const Primitive& primitive, double weight, SurfaceTargets& targets) {
  if (weight <= 0) return;
  const SurfaceTargets seen = targets;
  if (primitive.symmetry.revolution) carry_around(primitive, seen, weight, targets);
  if (primitive.symmetry.mirror_x) carry_across(primitive, {-1, 1, 1}, seen, weight, targets);
  if (primitive.symmetry.mirror_y) carry_across(primitive, {1, -1, 1}, seen, weight, targets);
  if (primitive.symmetry.mirror_x && primitive.symmetry.mirror_y) carry_across(primitive, {-1, -1, 1}, seen, weight, targets);
}

}  // namespace gfp
