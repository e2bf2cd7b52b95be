#include "modelling/density_rules.hpp"

#include <algorithm>
#include <limits>

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A position along one of the directions.
struct Position {
  Vector3d place;
  double distance_m = std::numeric_limits<double>::infinity();
  int count = std::numeric_limits<int>::max();
};

constexpr double kTieM = 1e-9;  ///< Positions are equally near within rounding.

/// Visits the positions along `direction` until `visit` returns false or the search ends.
template <class Visit>
void march(const Vector3d& place, const Vector3d& direction, double step_m, double search_m, Visit&& visit) {
  const double stride = step_m * direction.norm();
  for (int k = 1; k * stride <= search_m + kTieM; ++k)
    if (!visit(Vector3d(place + k * step_m * direction), k * stride)) return;
}

std::optional<Vector3d> out_of_density(const Vector3d& place, const std::vector<Vector3d>& directions, const PointCount& count, double step_m, double search_m) {
  Position best;
  for (const auto& direction : directions)
    march(place, direction, step_m, search_m, [&](const Vector3d& there, double distance_m) {
      if (best.count == 0 && distance_m >= best.distance_m - kTieM) return false;
      const int near = count(there.cast<float>());
      if (near < best.count || (near == best.count && distance_m < best.distance_m - kTieM)) best = {there, distance_m, near};
      return near > 0;
    });
  if (best.count == std::numeric_limits<int>::max()) return std::nullopt;
  return best.place;
}

std::optional<Vector3d> into_density(const Vector3d& place, const std::vector<Vector3d>& directions, const PointCount& count, double step_m, double search_m) {
  Position best;
  for (const auto& direction : directions)
    march(place, direction, step_m, search_m, [&](const Vector3d& there, double distance_m) {
      if (distance_m >= best.distance_m - kTieM) return false;
      if (count(there.cast<float>()) == 0) return true;
      best = {there, distance_m, 1};
      return false;
    });
  if (best.distance_m > search_m + kTieM) return std::nullopt;
  return best.place;
}

}  // namespace

std::vector<Vector3d> normal_directions(const Vector3d& normal) { return {normal, -normal}; }

std::vector<Vector3d> grid_directions(const Vector3d& normal) {
  std::vector<Vector3d> directions;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (x != 0 || y != 0 || z != 0) directions.emplace_back(x, y, z);
  std::stable_sort(directions.begin(), directions.end(), [&](const Vector3d& a, const Vector3d& b) { return normal.dot(a.normalized()) > normal.dot(b.normalized()); });
  return directions;
}

std::optional<Vector3d> best_candidate(const Vector3d& place, const std::vector<Vector3d>& directions, const PointCount& count, double step_m, double search_m) {
  return count(place.cast<float>()) > 0 ? out_of_density(place, directions, count, step_m, search_m)
                                        : into_density(place, directions, count, step_m, search_m);
}

}  // namespace gfp
