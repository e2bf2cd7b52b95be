#pragma once

#include <memory>
#include <string>

#include "gfp/modelling/fitted_model.hpp"

namespace gfp::test {

/// A closed box of `size_m`, base on z = 0, centred in x and y; triangles face outwards.
inline TriangleMesh box_mesh(const Eigen::Vector3d& size_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1 ? 0.5 : -0.5) * size_m.x(), (i & 2 ? 0.5 : -0.5) * size_m.y(), (i & 4 ? 1.0 : 0.0) * size_m.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline FittedModel box_model(const std::string& method = "gfp_robust", const std::string& class_name = "box",
                             const Eigen::Vector3d& size_m = Eigen::Vector3d(0.1, 0.1, 0.1), double cost = 0) {
  const TriangleMesh mesh = box_mesh(size_m);
  auto topology = std::make_shared<Topology>();
  topology->triangles = topology->filled_triangles = mesh.triangles;
  topology->types.assign(8, PointType::kControl);
  topology->parts.assign(8, Part::kBody);
  FittedModel model;
  model.method = method;
  model.class_name = class_name;
  model.topology = topology;
  model.vertices = mesh.vertices;
  model.size_m = size_m;
  model.states.assign(8, kVertexObserved | kVertexControl | kVertexMoved);
  model.sigma_m.assign(8, 0.001F);
  model.evidence.cost = cost;
  return model;
}

}  // namespace gfp::test
