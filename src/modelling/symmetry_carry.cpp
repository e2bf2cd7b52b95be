#include "modelling/symmetry_carry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kSameRing = 0.004;    ///< Canonical units: ring mates of families agree to rounding.
constexpr double kMirrorPartner = 0.02;///< Canonical units.
constexpr double kLeastRing = 2;       ///< Vertices seen per ring; meshes with fewer have no rings, but counterparts between their vertices.
constexpr double kNear = 0.05;         ///< Canonical units: how far counterparts of such meshes look.
constexpr double kSameSide = 0.7;      ///< Cosine between their normals.

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

/// Whether vertices have counterparts, as families make them: ring mates, or mirror images.
bool has_counterparts(const Primitive& primitive, const SurfaceTargets& seen) {
  const bool around = primitive.symmetry.revolution;
  const Vector3d mirror(primitive.symmetry.mirror_x ? -1 : 1, primitive.symmetry.mirror_y ? -1 : 1, 1);
  std::set<CellKey> cells;
  int count = 0, matched = 0;
  for (std::size_t i = 0; i < primitive.size(); ++i) {
    if (around && seen.weight[i] <= 0) continue;
    const Vector3d& p = primitive.mean[i];
    cells.insert(around ? cell_of({std::hypot(p.x(), p.y()), 0, p.z()}, primitive.topology->parts[i], kSameRing) : cell_of(p, primitive.topology->parts[i], kMirrorPartner));
    ++count;
  }
  if (around) return count >= kLeastRing * static_cast<double>(cells.size());
  for (std::size_t i = 0; i < primitive.size(); ++i) matched += cells.contains(cell_of(primitive.mean[i].cwiseProduct(mirror), primitive.topology->parts[i], kMirrorPartner)) ? 1 : 0;
  return 2 * matched >= count;
}

/// A vertex where all counterparts meet: turned into the half plane y = 0, or mirrored.
struct Counterpart {
  Vector3d point, normal;
  std::size_t vertex = 0;
  bool operator<(const Counterpart& other) const { return point.z() < other.point.z(); }
};

/// The seen vertices around where an unseen one falls, of the same part and facing the same way, by nearness: `seen_place` and `own_place`
/// bring a vector of a vertex at `point` to where counterparts meet.
template <class SeenPlace, class OwnPlace>
void carry_between_vertices(const Primitive& primitive, const SurfaceTargets& seen, double weight, SeenPlace&& seen_place, OwnPlace&& own_place, SurfaceTargets& targets) {
  const std::vector<Vector3d> normals = vertex_normals({primitive.mean, primitive.topology->triangles});
  std::vector<Counterpart> sorted;
  for (std::size_t i = 0; i < primitive.size(); ++i)
    if (seen.weight[i] > 0) sorted.push_back({seen_place(primitive.mean[i], primitive.mean[i]), seen_place(primitive.mean[i], normals[i]), i});
  std::stable_sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < primitive.size(); ++i) {
    if (seen.weight[i] > 0 || targets.weight[i] > 0) continue;
    const Vector3d point = own_place(primitive.mean[i], primitive.mean[i]), normal = own_place(primitive.mean[i], normals[i]);
    Pool pool;
    for (auto at = std::lower_bound(sorted.begin(), sorted.end(), Counterpart{point - Vector3d(0, 0, kNear), {}, 0}); at != sorted.end() && at->point.z() <= point.z() + kNear; ++at) {
      const double squared = (at->point - point).squaredNorm() / (kNear * kNear);
      if (squared >= 1 || primitive.topology->parts[at->vertex] != primitive.topology->parts[i] || at->normal.dot(normal) < kSameSide) continue;
      pool.include(seen.distance_m[at->vertex], seen.weight[at->vertex] * (1 - squared));
    }
    if (pool.weight <= 0) continue;
    targets.distance_m[i] = pool.weighted_sum / pool.weight;
    targets.weight[i] = weight * std::min(1.0, pool.weight);
  }
}

void carry_without_rings(const Primitive& primitive, const SurfaceTargets& seen, double weight, SurfaceTargets& targets) {
  const auto stays = [](const Vector3d&, const Vector3d& vector) { return vector; };
  const auto into_half_plane = [](const Vector3d& at, const Vector3d& vector) -> Vector3d {
    const double radius = std::max(std::hypot(at.x(), at.y()), 1e-12);
    return {(at.x() * vector.x() + at.y() * vector.y()) / radius, (at.x() * vector.y() - at.y() * vector.x()) / radius, vector.z()};
  };
  const auto mirrored = [&](const Vector3d& mirror) {
    carry_between_vertices(primitive, seen, weight, stays, [mirror](const Vector3d&, const Vector3d& vector) -> Vector3d { return mirror.cwiseProduct(vector); }, targets);
  };
  const Symmetry& symmetry = primitive.symmetry;
  if (symmetry.revolution) carry_between_vertices(primitive, seen, weight, into_half_plane, into_half_plane, targets);
  if (symmetry.mirror_x) mirrored({-1, 1, 1});
  if (symmetry.mirror_y) mirrored({1, -1, 1});
  if (symmetry.mirror_x && symmetry.mirror_y) mirrored({-1, -1, 1});
}

}  // namespace

void carry_by_symmetry(const Primitive& primitive, double weight, SurfaceTargets& targets) {
  const Symmetry& symmetry = primitive.symmetry;
  if (weight <= 0 || !(symmetry.revolution || symmetry.mirror_x || symmetry.mirror_y)) return;
  const SurfaceTargets seen = targets;
  if (!has_counterparts(primitive, seen)) return carry_without_rings(primitive, seen, weight, targets);
  if (primitive.symmetry.revolution) carry_around(primitive, seen, weight, targets);
  if (primitive.symmetry.mirror_x) carry_across(primitive, {-1, 1, 1}, seen, weight, targets);
  if (primitive.symmetry.mirror_y) carry_across(primitive, {1, -1, 1}, seen, weight, targets);
  if (primitive.symmetry.mirror_x && primitive.symmetry.mirror_y) carry_across(primitive, {-1, -1, 1}, seen, weight, targets);
}

}  // namespace gfp
