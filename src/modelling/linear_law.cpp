#include "modelling/linear_law.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>

namespace gfp {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

constexpr double kAtRestM = 1e-9;  ///< A control displaced by less drags nothing.

}  // namespace

std::vector<Reached> edge_distances(const TriangleMesh& mesh, const VertexAdjacency& adjacency, std::int32_t source, double reach_m) {
  using Entry = std::pair<double, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::map<std::int32_t, double> best{{source, 0.0}};
  std::vector<Reached> reached;
  queue.push({0.0, source});
  while (!queue.empty()) {
    const auto [distance, vertex] = queue.top();
    queue.pop();
    if (distance > best.at(vertex)) continue;
    reached.push_back({vertex, distance});
    for (std::int32_t k = adjacency.offsets[at(vertex)]; k < adjacency.offsets[at(vertex) + 1]; ++k) {
      const std::int32_t neighbour = adjacency.indices[at(k)];
      const double there = distance + (mesh.vertices[at(neighbour)] - mesh.vertices[at(vertex)]).norm();
      const auto known = best.find(neighbour);
      if (there >= reach_m || (known != best.end() && known->second <= there)) continue;
      best[neighbour] = there;
      queue.push({there, neighbour});
    }
  }
  return reached;
}

LinearLaw::LinearLaw(const TriangleMesh& rest, const std::vector<std::uint8_t>& is_control, double edge_m, double reach_m) : edge_m_(edge_m) {
  const VertexAdjacency adjacency = vertex_adjacency(rest);
  for (std::int32_t control = 0; control < static_cast<std::int32_t>(is_control.size()); ++control) {
    if (is_control[at(control)] == 0) continue;
    for (const auto& [vertex, distance_m] : edge_distances(rest, adjacency, control, std::max(reach_m, 2 * edge_m)))
      if (is_control[at(vertex)] == 0) pulls_.push_back({vertex, control, distance_m});
  }
  std::stable_sort(pulls_.begin(), pulls_.end(), [](const Pull& a, const Pull& b) { return a.regular < b.regular; });
}

void LinearLaw::drag(std::vector<Eigen::Vector3d>& displacements) const {
  for (std::size_t first = 0; first < pulls_.size();) {
    const std::int32_t regular = pulls_[first].regular;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (; first < pulls_.size() && pulls_[first].regular == regular; ++first) {
      const Eigen::Vector3d& displacement = displacements[at(pulls_[first].control)];
      const double length = displacement.norm();
      const double weight = 1 - pulls_[first].distance_m / std::max(length, 2 * edge_m_);
      if (length < kAtRestM || weight <= 0) continue;
      sum += weight * displacement;
      weights += weight;
    }
    displacements[at(regular)] = sum / std::max(1.0, weights);
  }
}

}  // namespace gfp
