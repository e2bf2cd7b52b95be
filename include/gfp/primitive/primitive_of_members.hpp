#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Shapes of one class in correspondence: the same vertex at the same index, object frame, metres.
struct ClassMembers {
  std::vector<std::vector<Eigen::Vector3d>> shapes;  ///< At least 1, of N points each.
  std::vector<Eigen::Vector3d> sizes_m;              ///< Reference size of each.
  std::vector<Triangle> triangles;                   ///< Closed.
  std::vector<Triangle> filled_triangles;            ///< The same with every cavity closed at its rim.
  std::vector<Part> parts;                           ///< N.
  /// A shape of the class that does not cross itself, object frame; empty where averages never do. A mean that crosses itself is kept on the
  /// way from here to it.
  std::vector<Eigen::Vector3d> sound;
  Eigen::Vector3d sound_size_m = Eigen::Vector3d::Ones();
};

/// What a class is known to be, beside its members' shapes.
struct ClassFacts {
  std::string name, class_name;
  std::vector<std::string> aliases;
  Symmetry symmetry;
  int genus = 0;
  bool hollow = false;
  double upright_share = 0.75;  ///< Prior of the canonical pose.
  int members = 0;              ///< Of which the shapes are symmetric copies, one after the other; 0: every shape is a member.
  double doubt_members = 0;     ///< Weight of wide general priors of size and unexplained shape, as so many members; 0: the members say it all.
  Provenance provenance;
};

/// The GFP of these members: mean, at most 8 modes, size prior, typing, stable poses, contact pairs, content hash; no training views.
/// Modes are shortened until the mean moved two standard deviations along any of them does not cross itself; one that would all but vanish
/// is dropped. Deterministic.
Primitive primitive_of_members(const ClassMembers& members, const ClassFacts& facts);

/// What follows from a primitive's shape, connectivity and manual types: types, features, contact pairs, rest edge length, hashes.
void complete_from_shape(Primitive& primitive);

/// The manual layer of point types replaced (empty, or one a vertex), and with it types and hashes; the automatic layer is found anew.
void set_manual_types(Primitive& primitive, std::vector<std::optional<PointType>> manual);

}  // namespace gfp
