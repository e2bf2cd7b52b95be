#include "grasp/shapes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace gfp::test {
namespace {

using Eigen::Vector3d;

/// Surface of revolution about z from a profile (radius, z) that starts and ends on the axis, walked so that outside is right.
TriangleMesh revolved(const std::vector<std::pair<double, double>>& profile, int segments) {
  TriangleMesh mesh;
  std::vector<std::vector<std::int32_t>> rows;
  for (const auto& [radius, z] : profile) {
    std::vector<std::int32_t> row;
    for (int s = 0; s < segments; ++s) {
      if (s == 0 || radius > 0) {
        const double angle = 2 * std::numbers::pi * s / segments;
        mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
      row.push_back(static_cast<std::int32_t>(mesh.vertices.size()) - 1);
    }
    rows.push_back(row);
  }
  for (std::size_t r = 0; r + 1 < rows.size(); ++r)
    for (std::size_t s = 0; s < rows[r].size(); ++s) {
      const std::size_t next = (s + 1) % rows[r].size();
      const std::int32_t a = rows[r][s], b = rows[r][next], c = rows[r + 1][next], d = rows[r + 1][s];
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

}  // namespace

TriangleMesh box_mesh(const Vector3d& size_m, int cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> index;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [place, fresh] = index.try_emplace(p, static_cast<std::int32_t>(mesh.vertices.size()));
    if (fresh)
      mesh.vertices.emplace_back(size_m.x() * (double(p[0]) / cells - 0.5), size_m.y() * (double(p[1]) / cells - 0.5), size_m.z() * p[2] / cells);
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, cells})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p{};
            p[static_cast<std::size_t>(axis)] = side;
            p[static_cast<std::size_t>((axis + 1) % 3)] = u;
            p[static_cast<std::size_t>((axis + 2) % 3)] = v;
            return vertex(p);
          };
          std::int32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          if (side == 0) std::swap(b, d);
          mesh.triangles.push_back({a, b, c});
          mesh.triangles.push_back({a, c, d});
        }
  return mesh;
}

TriangleMesh cylinder_mesh(double radius_m, double height_m, int segments, int rings) {
  std::vector<std::pair<double, double>> profile{{0, 0}, {0.5 * radius_m, 0}};
  for (int r = 0; r <= rings; ++r) profile.emplace_back(radius_m, height_m * r / rings);
  profile.emplace_back(0.5 * radius_m, height_m);
  profile.emplace_back(0, height_m);
  return revolved(profile, segments);
}

TriangleMesh sphere_mesh(double radius_m, int segments, int rings) {
  std::vector<std::pair<double, double>> profile{{0, 0}};
  for (int r = 1; r < rings; ++r) {
    const double angle = std::numbers::pi * r / rings;
    profile.emplace_back(radius_m * std::sin(angle), radius_m * (1 - std::cos(angle)));
  }
  profile.emplace_back(0, 2 * radius_m);
  return revolved(profile, segments);
}

TriangleMesh cup_mesh(double radius_m, double height_m, double wall_m, int segments) {
  constexpr int kRings = 8;
  std::vector<std::pair<double, double>> profile{{0, 0}, {0.5 * radius_m, 0}};
  for (int r = 0; r <= kRings; ++r) profile.emplace_back(radius_m, height_m * r / kRings);
  for (int r = kRings; r >= 0; --r) profile.emplace_back(radius_m - wall_m, wall_m + (height_m - wall_m) * r / kRings);
  profile.emplace_back(0.5 * radius_m, wall_m);
  profile.emplace_back(0, wall_m);
  return revolved(profile, segments);
}

TriangleMesh ring_mesh(double radius_m, double tube_m, int segments, int sides) {
  TriangleMesh mesh;
  for (int s = 0; s < segments; ++s)
    for (int k = 0; k < sides; ++k) {
      const double around = 2 * std::numbers::pi * s / segments, tube = 2 * std::numbers::pi * k / sides;
      const double r = radius_m + tube_m * std::cos(tube);
      mesh.vertices.emplace_back(r * std::cos(around), tube_m * std::sin(tube), radius_m + tube_m + r * std::sin(around));
    }
  for (int s = 0; s < segments; ++s)
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](int u, int v) { return static_cast<std::int32_t>((u % segments) * sides + v % sides); };
      mesh.triangles.push_back({at(s, k), at(s, k + 1), at(s + 1, k + 1)});
      mesh.triangles.push_back({at(s, k), at(s + 1, k + 1), at(s + 1, k)});
    }
  return mesh;
}

TriangleMesh cone_mesh(double radius_m, double height_m, int segments) {
  return revolved({{0, 0}, {0.5 * radius_m, 0}, {radius_m, 0}, {0.5 * radius_m, 0.5 * height_m}, {0, height_m}}, segments);
}

Transform camera_from_support() {
  const double down = 35 * std::numbers::pi / 180;
  Transform T_camera_support = Transform::Identity();
  T_camera_support.linear().col(0) = Vector3d(1, 0, 0);
  T_camera_support.linear().col(2) = Vector3d(0, -std::cos(down), -std::sin(down));
  T_camera_support.linear().col(1) = T_camera_support.linear().col(2).cross(T_camera_support.linear().col(0));
  T_camera_support.translation() = Vector3d(0, 0, 0.7);
  return T_camera_support;
}

GraspScene table_scene() {
  GraspScene scene;
  scene.has_support = true;
  scene.T_camera_support = camera_from_support();
  return scene;
}

FittedModel fit_of(const TriangleMesh& mesh, double sigma_m) {
  FittedModel model;
  auto topology = std::make_shared<Topology>();
  topology->triangles = mesh.triangles;
  model.topology = topology;
  model.vertices = mesh.vertices;
  model.T_camera_object = camera_from_support();
  model.states.assign(mesh.vertices.size(), kVertexObserved);
  model.sigma_m.assign(mesh.vertices.size(), static_cast<float>(sigma_m));
  return model;
}

}  // namespace gfp::test
