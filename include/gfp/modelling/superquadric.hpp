#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gfp/core/transform.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Superellipsoid of Barr (1981), 11 parameters: half axes a1 a2 a3, exponents epsilon1 (along z) and epsilon2 (across), pose.
///
///     F(x, y, z) = (|x/a1|^(2/epsilon2) + |y/a2|^(2/epsilon2))^(epsilon2/epsilon1) + |z/a3|^(2/epsilon1),   surface F = 1
///
/// Exponents lie in (0, 2], where the body is convex: 0 is a box, 1 an ellipsoid, 2 a double pyramid.
struct Superquadric {
  Eigen::Vector3d half_axes_m = Eigen::Vector3d::Ones();  ///< a1, a2, a3.
  double epsilon1 = 1, epsilon2 = 1;
  Transform pose = Transform::Identity();  ///< Maps body coordinates into the frame that its holder names.
};

/// F^(epsilon1/2): 0 at the centre, 1 on the surface, grows linearly along rays from the centre. Being two nested p-norms
/// it is computed from ratios <= 1, so it neither overflows nor loses sharp corners (cf. Vaskevicius & Birk, TPAMI 2019).
double gauge(const Superquadric& superquadric, const Eigen::Vector3d& point);

/// The classic in-out function F: < 1 inside. Overflows to infinity far away when epsilon1 is small; prefer gauge().
double inside_outside(const Superquadric& superquadric, const Eigen::Vector3d& point);

/// Signed distance to the surface along the ray from the centre, metres, positive outside; -(smallest half axis) at the centre.
double radial_distance(const Superquadric& superquadric, const Eigen::Vector3d& point);

/// Signed distance to the tangent plane at the radial projection (gauge - 1)/|grad gauge|, metres: first-order Euclidean.
double surface_distance(const Superquadric& superquadric, const Eigen::Vector3d& point);

/// max over the body of direction . (p - centre), metres for a unit direction: how far it reaches. Closed form (dual norm).
double reach(const Superquadric& superquadric, const Eigen::Vector3d& direction);

/// 2 a1 a2 a3 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2), m^3 (Jaklic, Leonardis, Solina 2000).
double volume(const Superquadric& superquadric);

/// Connectivity of every superquadric mesh, one object a process: 32 meridians x 19 rings and two poles, 610 vertices,
/// 1216 triangles, closed and oriented.
std::shared_ptr<const Topology> superquadric_topology();

/// Vertices for superquadric_topology() in the frame of `pose`: about equal arcs along rings and meridians, each corner and edge of a
/// sharp body on a vertex. All on the surface, no triangle crosses another, for exponents in [0.01, 2] and any positive half axes.
std::vector<Eigen::Vector3d> superquadric_vertices(const Superquadric& superquadric);

}  // namespace gfp
