// Eq. 6 (P23): what is printed sums squares with signs and cannot tell equilibrium; what is solved is the Euler-Lagrange equation of the energy,
//     w n (n . u - d) - alpha lap(u) + beta bilap(u) = 0, u from rest.
#include "gfp/modelling/contour_solver.hpp"

#include <gtest/gtest.h>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "support/printed_forms.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kAlpha = 0.4, kBeta = 1.0;

/// A can, half of which is pulled about by made-up data.
struct Pulled {
  TriangleMesh mesh = test::cylinder(0.04, 0.1, 16, 6);
  VertexAdjacency adjacency = vertex_adjacency(mesh);
  std::vector<Vector3d> normals = vertex_normals(mesh);
  std::vector<double> targets, weights;
  ContourSolver solver{topology(), mesh.vertices.size(), kAlpha, kBeta};

  explicit Pulled(std::uint64_t seed) {
    Random random(seed);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const bool seen = mesh.vertices[i].x() > 0;
      weights.push_back(seen ? random.uniform() : 0.0);
      targets.push_back(seen ? 0.01 * (random.uniform() - 0.5) : 0.0);
    }
  }

  Topology topology() const {
    Topology topology;
    topology.triangles = mesh.triangles;
    return topology;
  }
  Eigen::MatrixX3d rest() const { return Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(mesh.vertices.size()), 3); }
  Eigen::MatrixX3d converged() const {
    Eigen::MatrixX3d u = rest();
    for (int k = 0; k < 4000; ++k) u = solver.step(u, normals, targets, weights);
    return u;
  }

  /// u_i minus the mean of its neighbours: minus the Laplacian, in units of edge lengths.
  Vector3d bend(const Eigen::MatrixX3d& u, std::size_t i) const {
    Vector3d mean = Vector3d::Zero();
    for (auto k = adjacency.offsets[i]; k < adjacency.offsets[i + 1]; ++k) mean += u.row(adjacency.indices[static_cast<std::size_t>(k)]).transpose();
    return u.row(static_cast<Eigen::Index>(i)).transpose() - mean / degree(i);
  }
  double degree(std::size_t i) const { return adjacency.offsets[i + 1] - adjacency.offsets[i]; }

  /// The left side of the equation at vertex i, term by term from the mesh's connectivity.
  Vector3d residual(const Eigen::MatrixX3d& u, std::size_t i) const {
    Vector3d stretch = 0.5 * bend(u, i) + 0.5 * u.row(static_cast<Eigen::Index>(i)).transpose(), plate = bend(u, i);
    for (auto k = adjacency.offsets[i]; k < adjacency.offsets[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(adjacency.indices[static_cast<std::size_t>(k)]);
      stretch -= 0.5 / degree(j) * u.row(static_cast<Eigen::Index>(j)).transpose();
      plate -= bend(u, j) / degree(j);
    }
    const double along = normals[i].dot(u.row(static_cast<Eigen::Index>(i)).transpose()) - targets[i];
    return weights[i] * along * normals[i] + kAlpha * stretch + kBeta * plate;
  }
};

TEST(ContourSolver, StopsWhereForcesBalance) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Pulled can(seed);
    const Eigen::MatrixX3d u = can.converged();
    EXPECT_GT(u.rowwise().norm().maxCoeff(), 5e-4) << "the data did pull";
    for (std::size_t i = 0; i < can.mesh.vertices.size(); ++i) ASSERT_LT(can.residual(u, i).norm(), 1e-9) << "seed " << seed << ", vertex " << i;
  }
}

TEST(ContourSolver, EveryStepLowersTheEnergy) {
  const Pulled can(4);
  Eigen::MatrixX3d u = can.rest();
  double energy = can.solver.energy(u, can.normals, can.targets, can.weights);
  for (int k = 0; k < 20; ++k) {
    u = can.solver.step(u, can.normals, can.targets, can.weights);
    const double next = can.solver.energy(u, can.normals, can.targets, can.weights);
    ASSERT_LT(next, energy) << "step " << k;
    energy = next;
  }
}

TEST(ContourSolver, WhatLiesOnItsDataStays) {
  Pulled can(5);
  can.targets.assign(can.targets.size(), 0.0);
  EXPECT_EQ(can.solver.step(can.rest(), can.normals, can.targets, can.weights).cwiseAbs().maxCoeff(), 0);
}

// As printed: a flat sheet that lies on its data is in no equilibrium, one that is torn and bent at once may be, and no balance of forces is
// seen at all, since squares have no direction.
TEST(PrintedEulerLagrange, CannotTellEquilibrium) {
  constexpr double kEdge = 0.005;
  const Vector3d p(0, 0, 0), before_s(-kEdge, 0, 0), before_r(0, -kEdge, 0);
  const double flat = test::printed::continuity(p, before_s, before_r);
  EXPECT_GT(test::printed::equilibrium(0, kAlpha, flat, kBeta, 0), 0) << "at rest, on the data";
  const double stretched = 4 * flat, bent = kAlpha * stretched / kBeta;
  EXPECT_EQ(test::printed::equilibrium(0, kAlpha, stretched, kBeta, bent), 0) << "stretched to twice its length, and bent";
  const Vector3d after_s = 2 * p - before_s + Vector3d(0, 0, std::sqrt(bent)), other_side = 2 * p - before_s - Vector3d(0, 0, std::sqrt(bent));
  EXPECT_DOUBLE_EQ((before_s - 2 * p + after_s).squaredNorm(), (before_s - 2 * p + other_side).squaredNorm()) << "bent up or down is the same to it";
}

}  // namespace
}  // namespace gfp
