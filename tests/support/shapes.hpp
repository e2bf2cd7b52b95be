#pragma once

#include <cmath>
#include <numbers>

#include "gfp/core/mesh.hpp"

namespace gfp::test {

/// Axis-aligned box centred on x and y, from z = 0 to `size.z()`.
inline TriangleMesh box(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back(((k & 1) ? 0.5 : -0.5) * size.x(), ((k & 2) ? 0.5 : -0.5) * size.y(), (k & 4) ? size.z() : 0.0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Closed solid of revolution about z: `profile` holds (radius, z) from bottom to top, radii > 0; poles are capped by fans.
inline TriangleMesh revolve(const std::vector<Eigen::Vector2d>& profile, int segments) {
  TriangleMesh mesh;
  for (const auto& p : profile)
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * std::numbers::pi * s / segments;
      mesh.vertices.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
    }
  const auto at = [segments](int ring, int s) { return static_cast<std::int32_t>(ring * segments + s % segments); };
  const int rings = static_cast<int>(profile.size());
  for (int r = 0; r + 1 < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      mesh.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
    }
  const auto bottom = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, profile.front().y());
  const auto top = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, profile.back().y());
  for (int s = 0; s < segments; ++s) {
    mesh.triangles.push_back({bottom, at(0, s + 1), at(0, s)});
    mesh.triangles.push_back({top, at(rings - 1, s), at(rings - 1, s + 1)});
  }
  return mesh;
}

inline TriangleMesh cylinder(double radius, double height, int segments = 32, int rings = 8) {
  std::vector<Eigen::Vector2d> profile;
  for (int r = 0; r <= rings; ++r) profile.emplace_back(radius, height * r / rings);
  return revolve(profile, segments);
}

/// UV sphere centred on the origin.
inline TriangleMesh sphere(double radius, int segments = 32, int rings = 16) {
  std::vector<Eigen::Vector2d> profile;
  for (int r = 1; r < rings; ++r) {
    const double angle = std::numbers::pi * r / rings;
    profile.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
  }
  TriangleMesh mesh = revolve(profile, segments);
  mesh.vertices[mesh.vertices.size() - 2].z() = -radius;
  mesh.vertices[mesh.vertices.size() - 1].z() = radius;
  return mesh;
}

/// Torus about z through the origin; genus 1.
inline TriangleMesh torus(double ring_radius, double tube_radius, int around = 32, int tube = 16) {
  TriangleMesh mesh;
  for (int a = 0; a < around; ++a)
    for (int t = 0; t < tube; ++t) {
      const double phi = 2 * std::numbers::pi * a / around, theta = 2 * std::numbers::pi * t / tube;
      const double r = ring_radius + tube_radius * std::cos(theta);
      mesh.vertices.emplace_back(r * std::cos(phi), r * std::sin(phi), tube_radius * std::sin(theta));
    }
  const auto at = [&](int a, int t) { return static_cast<std::int32_t>((a % around) * tube + t % tube); };
  for (int a = 0; a < around; ++a)
    for (int t = 0; t < tube; ++t) {
      mesh.triangles.push_back({at(a, t), at(a + 1, t), at(a + 1, t + 1)});
      mesh.triangles.push_back({at(a, t), at(a + 1, t + 1), at(a, t + 1)});
    }
  return mesh;
}

}  // namespace gfp::test
