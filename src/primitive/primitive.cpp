#include "gfp/primitive/primitive.hpp"

#include <algorithm>

namespace gfp {

std::vector<Eigen::Vector3d> shape(const Primitive& primitive, const Eigen::Vector3d& size_m, const std::vector<double>& modes) {
  std::vector<Eigen::Vector3d> vertices = primitive.mean;
  for (std::size_t k = 0; k < std::min(modes.size(), primitive.modes.size()); ++k)
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] += modes[k] * primitive.modes[k][i];
  for (auto& v : vertices) v = v.cwiseProduct(size_m);
  return vertices;
}

}  // namespace gfp
