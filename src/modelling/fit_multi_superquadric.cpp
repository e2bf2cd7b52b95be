#include "gfp/modelling/fit_multi_superquadric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gfp/core/isosurface.hpp"
#include "gfp/core/simplified.hpp"
#include "gfp/core/union_find.hpp"
#include "gfp/modelling/fit_superquadric.hpp"
#include "gfp/primitive/content_hash.hpp"
#include "modelling/recover_from_view.hpp"
#include "modelling/volume_model.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLeastPoints = 30;     ///< Of a body.
constexpr double kIndependence = 0.05;       ///< Neighbouring pixels err alike: this share of the points counts.
constexpr double kMostNats = 12.5;           ///< A point at five sigmas and one farther off are equally unexplained.
constexpr double kWorthBody = 15.0;          ///< Nats: eleven parameters more.
constexpr double kNearSupport = 0.015;       ///< Metres: a part that is seen so far down stands on the support.
constexpr double kNeighbours = 0.012;        ///< Metres between the points of one group.
constexpr int kSearchIterations = 6;

struct Body {
  SeenSurface seen;
  bool on_support = false;
  SeenSuperquadric shape;
  bool whole = false;  ///< No division of it pays.
};

/// The union's signed distance, metres: positive outside.
double outside(const std::vector<Body>& bodies, const Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) least = std::min(least, surface_distance(body.shape.superquadric, point));
  return least;
}

double cost_nats(const std::vector<Body>& bodies, const SeenSurface& seen) {
  const double variance = seen.sigma_m * seen.sigma_m + kModelError * kModelError;
  double sum = 0;
  for (const Vector3d& p : seen.points) {
    const double distance = outside(bodies, p);
    sum += std::min(kMostNats, 0.5 * distance * distance / variance);
  }
  return kIndependence * sum + kWorthBody * static_cast<double>(bodies.size());
}

/// The part of what is seen whose points are marked; a tangent goes with the point that it passes nearest.
SeenSurface marked_part(const SeenSurface& seen, const std::vector<std::uint8_t>& marked, bool mark) {
  SeenSurface part;
  part.eye = seen.eye;
  part.sigma_m = seen.sigma_m;
  part.pixel_m = seen.pixel_m;
  for (std::size_t k = 0; k < seen.points.size(); ++k)
    if ((marked[k] != 0) == mark) part.points.push_back(seen.points[k]);
  for (const Ray& ray : seen.tangents) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < seen.points.size(); ++k) {
      const double distance = (seen.points[k] - ray.origin).cross(ray.direction).squaredNorm();
      if (distance < least) least = distance, nearest = k;
    }
    if (!seen.points.empty() && (marked[nearest] != 0) == mark) part.tangents.push_back(ray);
  }
  part.outer_points = near_side_of_hull(part.points, part.eye);
  return part;
}

std::optional<Body> fitted_body(SeenSurface seen, bool may_stand, int iterations) {
  if (seen.points.size() < kLeastPoints || !tells_a_shape(seen)) return std::nullopt;
  Body body{std::move(seen), false, {}};
  body.on_support = may_stand && bounds(body.seen.points).low.z() < kNearSupport;
  body.shape = recover_from_view(body.seen, body.on_support, iterations);
  if (!is_plausible(body.shape.superquadric, box_about(body.seen.points, body.on_support))) return std::nullopt;
  return body;
}

/// The largest group of points that the body leaves unexplained.
std::vector<std::uint8_t> unexplained(const Body& body) {
  const auto& points = body.seen.points;
  const double limit = 3 * std::hypot(body.seen.sigma_m, kModelError);
  std::vector<std::size_t> off;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (std::abs(surface_distance(body.shape.superquadric, points[k])) > limit) off.push_back(k);
  UnionFind groups(off.size());
  for (std::size_t a = 0; a < off.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if ((points[off[a]] - points[off[b]]).squaredNorm() < kNeighbours * kNeighbours) groups.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  std::vector<int> sizes(off.size(), 0);
  for (std::size_t a = 0; a < off.size(); ++a) ++sizes[static_cast<std::size_t>(groups.root(static_cast<std::int32_t>(a)))];
  std::vector<std::uint8_t> marked(points.size(), 0);
  if (off.empty()) return marked;
  const auto largest = static_cast<std::int32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::size_t a = 0; a < off.size(); ++a) marked[off[a]] = groups.root(static_cast<std::int32_t>(a)) == largest;
  return marked;
}

/// The ways in which a body's points may be divided.
std::vector<std::vector<std::uint8_t>> divisions(const Body& body) {
  std::vector<std::vector<std::uint8_t>> ways{unexplained(body)};
  const auto& points = body.seen.points;
  std::vector<double> along(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d direction = body.shape.superquadric.pose.linear().col(axis);
    for (std::size_t k = 0; k < points.size(); ++k) along[k] = direction.dot(points[k]);
    const auto [low, high] = std::minmax_element(along.begin(), along.end());
    for (const double share : {0.25, 0.5, 0.75}) {
      const double cut = *low + share * (*high - *low);
      auto& marked = ways.emplace_back(points.size());
      for (std::size_t k = 0; k < points.size(); ++k) marked[k] = along[k] < cut;
    }
  }
  return ways;
}

/// Bodies with number k replaced by two.
std::optional<std::vector<Body>> divided(const std::vector<Body>& bodies, std::size_t k, const std::vector<std::uint8_t>& marked, bool has_support, int iterations) {
  std::vector<Body> result = bodies;
  for (const bool mark : {false, true}) {
    auto half = fitted_body(marked_part(bodies[k].seen, marked, mark), has_support, iterations);
    if (!half) return std::nullopt;
    if (mark) result.push_back(std::move(*half));
    else result[k] = std::move(*half);
  }
  return result;
}

/// Divides the body in the best way; marks it as whole where none pays.
void divide(std::vector<Body>& bodies, std::size_t k, const SeenSurface& seen, bool has_support, int iterations) {
  double least = cost_nats(bodies, seen);
  std::optional<std::vector<Body>> best;
  std::vector<std::uint8_t> best_division;
  for (const auto& marked : divisions(bodies[k])) {
    auto tried = divided(bodies, k, marked, has_support, kSearchIterations);
    if (!tried) continue;
    const double cost = cost_nats(*tried, seen);
    if (cost >= least) continue;
    least = cost;
    best = std::move(tried);
    best_division = marked;
  }
  if (!best) {
    bodies[k].whole = true;
    return;
  }
  auto refined = divided(bodies, k, best_division, has_support, iterations);
  bodies = refined && cost_nats(*refined, seen) < least ? std::move(*refined) : std::move(*best);
}

std::vector<Body> recover_bodies(const SeenSurface& seen, bool has_support, const FitMultiSuperquadricOptions& options) {
  std::vector<Body> bodies(1);
  bodies[0] = {seen, has_support, recover_from_view(seen, has_support, options.max_iterations)};
  while (static_cast<int>(bodies.size()) < options.max_bodies) {
    const auto next = std::find_if(bodies.begin(), bodies.end(), [](const Body& body) { return !body.whole; });
    if (next == bodies.end()) break;
    divide(bodies, static_cast<std::size_t>(next - bodies.begin()), seen, has_support, options.max_iterations);
  }
  return bodies;
}

/// The union above the support (z = 0) as one closed surface.
TriangleMesh union_surface(const std::vector<Body>& bodies, bool has_support, const FitMultiSuperquadricOptions& options) {
  Bounds box;
  for (const Body& body : bodies)
    for (const Vector3d& v : superquadric_vertices(body.shape.superquadric)) box.include(v);
  if (has_support) box.low.z() = std::max(box.low.z(), 0.0);
  const double step = box.size().maxCoeff() / options.samples;
  const Eigen::Vector3i samples = (box.size() / step).array().ceil().cast<int>() + 3;
  ScalarGrid field(box.low - Vector3d::Constant(step), step, samples);
  for (int k = 0; k < samples.z(); ++k)
    for (int j = 0; j < samples.y(); ++j)
      for (int i = 0; i < samples.x(); ++i) {
        const Vector3d p = field.place({i, j, k});
        double least = std::numeric_limits<double>::infinity();
        for (const Body& body : bodies) least = std::min(least, radial_distance(body.shape.superquadric, p));
        field.values[field.index(i, j, k)] = static_cast<float>(has_support ? std::min(-least, p.z()) : -least);
      }
  const TriangleMesh surface = largest_component(isosurface(field, 0.0F));
  const auto few = simplified(surface, options.vertices);
  return few ? *few : surface;
}

}  // namespace

FittedModel fit_multi_superquadric(const ObjectView& view, const FitMultiSuperquadricOptions& options) {
  const SeenSurface seen = collect_seen_surface(view, options.max_points, kMaxTangents);
  const auto as_one = [&] {
    FittedModel model = fit_superquadric(view, {.max_points = options.max_points, .max_iterations = options.max_iterations});
    model.method = "multi_superquadric";
    return model;
  };
  if (!tells_a_shape(seen)) return as_one();
  const std::vector<Body> bodies = recover_bodies(seen, view.has_support, options);
  const Superquadric& first = bodies[0].shape.superquadric;
  if (bodies.size() == 1 && !is_plausible(first, box_about(seen.points, view.has_support))) return as_one();
  TriangleMesh surface = union_surface(bodies, view.has_support, options);
  if (surface.triangles.empty()) return as_one();

  auto topology = std::make_shared<Topology>();
  topology->triangles = topology->filled_triangles = std::move(surface.triangles);
  topology->types.assign(surface.vertices.size(), PointType::kRegular);
  topology->parts.assign(surface.vertices.size(), Part::kBody);
  topology->hash = topology_hash(*topology);
  FittedModel model = volume_model(view, {"multi_superquadric", std::move(topology), std::move(surface.vertices), horizontal_axis(first), bodies[0].shape.sigma_m,
                                          bodies[0].shape.pose_information, first.pose.translation()});
  for (const Body& body : bodies) model.iterations += body.shape.iterations;
  model.converged = std::all_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.shape.converged; });
  return model;
}

}  // namespace gfp
