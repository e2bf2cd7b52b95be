#include "modelling/paper_energy.hpp"

namespace gfp {

InternalEnergy internal_energy(const VertexAdjacency& adjacency, const std::vector<Eigen::Vector3d>& displacements, std::int32_t vertex,
                               const Eigen::Vector3d& displacement) {
  const auto first = static_cast<std::size_t>(adjacency.offsets[static_cast<std::size_t>(vertex)]);
  const auto end = static_cast<std::size_t>(adjacency.offsets[static_cast<std::size_t>(vertex) + 1]);
  if (first == end) return {};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  InternalEnergy energy;
  for (std::size_t k = first; k < end; ++k) {
    const Eigen::Vector3d& neighbour = displacements[static_cast<std::size_t>(adjacency.indices[k])];
    energy.continuity += (displacement - neighbour).squaredNorm();
    mean += neighbour;
  }
  const auto count = static_cast<double>(end - first);
  energy.continuity /= count;
  energy.curvature = (displacement - mean / count).squaredNorm();
  return energy;
}

}  // namespace gfp
