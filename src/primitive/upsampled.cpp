#include "gfp/primitive/upsampled.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "gfp/core/split_triangle.hpp"
#include "gfp/primitive/primitive_of_members.hpp"

namespace gfp {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

std::size_t at(std::int32_t v) { return static_cast<std::size_t>(v); }

/// The middles of a surface's edges: new vertices behind the old ones.
class Middles {
 public:
  Middles(const std::vector<Triangle>& triangles, std::size_t vertices) {
    auto next = static_cast<std::int32_t>(vertices);
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k)
        if (const auto [place, fresh] = of_.try_emplace(edge(t[k], t[(k + 1) % 3]), next); fresh) {
          ends_.push_back(place->first);
          ++next;
        }
  }

  /// Edges that the surface does not have (across a lid) stay whole.
  std::vector<Triangle> split(const std::vector<Triangle>& triangles) const {
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto found = of_.find(edge(a, b));
      return found == of_.end() ? -1 : found->second;
    };
    std::vector<Triangle> result;
    for (const Triangle& t : triangles) split_triangle(t, {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])}, result);
    return result;
  }

  /// Appends to a value per vertex one per middle.
  template <class Value, class Between>
  void extend(std::vector<Value>& values, Between&& between) const {
    for (const auto& [a, b] : ends_) values.push_back(between(values[at(a)], values[at(b)]));
  }

 private:
  static Edge edge(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

  std::map<Edge, std::int32_t> of_;
  std::vector<Edge> ends_;
};

/// Between two parts lies a rim before a body, and what is neither before the body.
Part part_between(Part a, Part b) {
  if (a == b || b == Part::kBody) return a;
  if (a == Part::kBody || b == Part::kRim) return b;
  return a;
}

void halve_edges(Primitive& primitive) {
  Topology topology = *primitive.topology;
  const Middles middles(topology.triangles, primitive.size());
  const auto mean_of = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d { return 0.5 * (a + b); };
  middles.extend(primitive.mean, mean_of);
  for (auto& mode : primitive.modes) middles.extend(mode, mean_of);
  middles.extend(topology.parts, part_between);
  if (!primitive.manual_types.empty()) primitive.manual_types.resize(primitive.size());
  topology.triangles = middles.split(topology.triangles);
  topology.filled_triangles = middles.split(topology.filled_triangles);
  primitive.topology = std::make_shared<const Topology>(std::move(topology));
}

}  // namespace

Primitive upsampled(const Primitive& primitive, int levels) {
  if (levels <= 0) return primitive;
  Primitive finer = primitive;
  for (int level = 0; level < std::min(levels, kMaxUpsampling); ++level) halve_edges(finer);
  complete_from_shape(finer);
  return finer;
}

}  // namespace gfp
