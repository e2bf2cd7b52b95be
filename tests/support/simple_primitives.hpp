#pragma once

#include <cmath>

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"
#include "support/shapes.hpp"

// Primitives small enough to reason about, so that the stages' tests do not depend on the shipped library.

namespace gfp::test {

inline PrimitivePtr finished(Primitive primitive, const TriangleMesh& unit) {
  Topology topology;
  topology.triangles = topology.filled_triangles = unit.triangles;
  topology.types.assign(unit.vertices.size(), PointType::kControl);
  topology.parts.assign(unit.vertices.size(), Part::kBody);
  topology.hash = 0x1000 + unit.vertices.size();
  primitive.mean = unit.vertices;
  primitive.topology = std::make_shared<const Topology>(std::move(topology));
  primitive.content_hash = std::hash<std::string>{}(primitive.class_name);
  return std::make_shared<const Primitive>(std::move(primitive));
}

/// Upright can of radius about 40 mm and height about 120 mm; mode 0 makes it conical, mode 1 waisted.
inline PrimitivePtr can_primitive() {
  Primitive primitive;
  primitive.name = primitive.class_name = "can";
  const TriangleMesh unit = cylinder(0.5, 1.0, 24, 10);
  for (const auto& profile : {+[](double z) { return 0.1 * (2 * z - 1); }, +[](double z) { return 0.1 * std::cos(2 * std::numbers::pi * z); }}) {
    std::vector<Eigen::Vector3d> mode;
    for (const auto& p : unit.vertices) mode.emplace_back(p.x() * 2 * profile(p.z()), p.y() * 2 * profile(p.z()), 0);
    primitive.modes.push_back(mode);
    primitive.mode_sigma.push_back(0.07);
  }
  primitive.log_size_mean = Eigen::Vector3d(0.08, 0.08, 0.12).array().log().matrix();
  primitive.log_size_covariance << 0.06, 0.0599, 0.01, 0.0599, 0.06, 0.01, 0.01, 0.01, 0.08;
  primitive.symmetry = {.revolution = true, .cyclic = 1, .mirror_x = true, .mirror_y = true, .flip_z = true};
  StablePose lying{Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix(), 0.15, "lying"};
  primitive.stable_poses = {{Eigen::Matrix3d::Identity(), 0.85, "upright"}, lying};
  return finished(std::move(primitive), unit);
}

/// A box of any proportions, subdivided so that every face has inner vertices.
inline PrimitivePtr box_primitive() {
  constexpr int kSide = 6;
  TriangleMesh unit;
  // Six grids welded along their edges: each lattice point of the cube's surface exists once.
  std::vector<std::int32_t> index((kSide + 1) * (kSide + 1) * (kSide + 1), -1);
  const auto vertex = [&](int x, int y, int z) {
    auto& known = index[static_cast<std::size_t>((z * (kSide + 1) + y) * (kSide + 1) + x)];
    if (known < 0) {
      known = static_cast<std::int32_t>(unit.vertices.size());
      unit.vertices.emplace_back(x / double(kSide) - 0.5, y / double(kSide) - 0.5, z / double(kSide));
    }
    return known;
  };
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    unit.triangles.push_back({a, b, c});
    unit.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      quad(vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0), vertex(i + 1, j, 0));
      quad(vertex(i, j, kSide), vertex(i + 1, j, kSide), vertex(i + 1, j + 1, kSide), vertex(i, j + 1, kSide));
      quad(vertex(i, 0, j), vertex(i + 1, 0, j), vertex(i + 1, 0, j + 1), vertex(i, 0, j + 1));
      quad(vertex(i, kSide, j), vertex(i, kSide, j + 1), vertex(i + 1, kSide, j + 1), vertex(i + 1, kSide, j));
      quad(vertex(0, i, j), vertex(0, i, j + 1), vertex(0, i + 1, j + 1), vertex(0, i + 1, j));
      quad(vertex(kSide, i, j), vertex(kSide, i + 1, j), vertex(kSide, i + 1, j + 1), vertex(kSide, i, j + 1));
    }
  Primitive primitive;
  primitive.name = primitive.class_name = "box";
  primitive.log_size_mean = Eigen::Vector3d(0.09, 0.09, 0.12).array().log().matrix();
  primitive.log_size_covariance = 0.25 * Eigen::Matrix3d::Identity();
  primitive.symmetry = {.revolution = false, .cyclic = 2, .mirror_x = true, .mirror_y = true, .flip_z = true};
  primitive.stable_poses = {{Eigen::Matrix3d::Identity(), 1.0, "upright"}};
  return finished(std::move(primitive), unit);
}

}  // namespace gfp::test
