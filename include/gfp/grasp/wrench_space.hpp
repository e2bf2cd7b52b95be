#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// One contact as the grasp wrench space sees it.
struct WrenchContact {
  Eigen::Vector3d point;   ///< Metres, any frame.
  Eigen::Vector3d normal;  ///< Unit, into the object, same frame.
  double friction = 0.5;   ///< Coulomb coefficient mu, > 0.
  double torsion_m = 0;    ///< Effective pad radius e; 0 is a hard finger (point contact with friction).
};

/// Where torques are taken about and what makes them comparable with forces: an object's centroid and bounding radius.
struct WrenchScale {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< Same frame as the contacts.
  double radius_m = 1;                               ///< Torques are divided by it.
};

/// Centroid of the volume and the distance of the farthest vertex from it.
WrenchScale wrench_scale(const TriangleMesh& mesh);

struct WrenchSpaceOptions {
  int cone_edges = 8;   ///< Edges of the friction polygon, 3 to 64.
  bool volume = false;  ///< Also the volume; costs the whole hull for three contacts and more, nothing for two.
};

using Wrench = Eigen::Matrix<double, 6, 1>;  ///< (force, torque / radius_m).

/// What the grasp wrench space W says of a grasp.
struct GraspQuality {
  bool force_closure = false;  ///< The origin is strictly inside W.
  double epsilon = 0;          ///< Radius of the largest ball about the origin inside W (Ferrari & Canny, ICRA 1992); 0 without force closure.
  double volume = 0;           ///< Six-dimensional volume of W; 0 where not asked for, or where W is flat.
};

/// The generators of W, contact after contact: W is their convex hull (L1: the normal forces of all contacts sum to 1).
///
/// With inward normal n, tangents (t1, t2) = orthonormal_basis(n), E = cone_edges and p the point relative to the centre:
///   edges    f_j = n + mu (cos(2 pi j / E) t1 + sin(2 pi j / E) t2), j = 0 .. E - 1:  w = (f_j, p x f_j / radius)
///   poles    for torsion_m > 0 only, after the edges, + then -:  w = (n, (p x n +- mu e n) / radius)
/// A soft finger thus spends one friction budget on tangential force and torsion together: |f_t| / mu + |m_n| / (mu e) <= f_n
/// (with |f_t| the polygon's norm), the inner approximation of the friction limit ellipsoid (Howe & Cutkosky 1996) by the
/// hull of its tangential polygon and its two torsional poles. It never promises a wrench that the ellipsoid cannot give.
/// The tangents are core's: for n = (x, y, z), s = z < 0 ? -1 : 1, a = -1 / (s + z), b = x y a:
///   t1 = (1 + s x^2 a, s b, -s x),  t2 = (b, s + y^2 a, -y).
std::vector<Wrench> primitive_wrenches(std::span<const WrenchContact> contacts, const WrenchScale& scale,
                                       const WrenchSpaceOptions& options = {});

/// Exact epsilon (to about 1e-9), force closure and, on request, volume of the grasp wrench space.
///
/// Two soft contacts have a closed form (see soft_pair.hpp), everything else expands an inner polytope towards the
/// nearest facet until that facet is the hull's own (see wrench_hull.hpp). A wrench space of less than six dimensions
/// (no contact, one contact, two hard fingers) has epsilon 0. Deterministic; thread-safe: no shared state.
/// Cost: about 2 us for two soft contacts, some hundred for four.
GraspQuality grasp_quality(std::span<const WrenchContact> contacts, const WrenchScale& scale, const WrenchSpaceOptions& options = {});

/// A lower bound of epsilon that needs no hull: the largest ball whose wrenches are balanced by the least-squares response
/// to them on top of the internal force nearest to equal shares, without leaving a friction cone. At most epsilon; 0 says
/// nothing. Cost: about 1 us a contact.
double epsilon_lower_bound(std::span<const WrenchContact> contacts, const WrenchScale& scale, const WrenchSpaceOptions& options = {});

}  // namespace gfp
