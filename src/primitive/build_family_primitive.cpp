#include <cassert>

#include "gfp/primitive/contact_pairs.hpp"
#include "gfp/primitive/content_hash.hpp"
#include "gfp/primitive/families.hpp"
#include "gfp/primitive/stable_poses.hpp"
#include "gfp/primitive/type_points.hpp"
#include "primitive/family_shape.hpp"
#include "primitive/shape_modes.hpp"

namespace gfp {
namespace {

constexpr int kMembers = 200;
constexpr int kModes = 8;
constexpr std::uint64_t kSeed = 42;
constexpr double kCheckedSigma = 2.0;  // the mean moved this far along any mode crosses itself nowhere

bool crosses_itself(const Primitive& primitive, const std::vector<double>& modes) {
  return count_self_intersections({shape(primitive, primitive.typical_size_m(), modes), primitive.topology->triangles}, 1) > 0;
}

/// Shrinks a mode until the mean +- 2 sigma is free of intersections: the classes' parameters are not quite linear.
void limit_modes(Primitive& primitive) {
  constexpr double kStep = 0.85;
  for (std::size_t k = 0; k < primitive.modes.size(); ++k) {
    std::vector<double> plus(k + 1, 0.0), minus(k + 1, 0.0);
    plus[k] = kCheckedSigma;
    minus[k] = -kCheckedSigma;
    while (crosses_itself(primitive, plus) || crosses_itself(primitive, minus)) {
      for (auto& displacement : primitive.modes[k]) displacement *= kStep;
      primitive.mode_sigma[k] *= kStep;
    }
  }
}

std::shared_ptr<Topology> family_topology(const FamilyInstance& instance) {
  auto topology = std::make_shared<Topology>();
  topology->triangles = instance.mesh.triangles;
  topology->filled_triangles = instance.filled_triangles;
  topology->parts = instance.parts;
  return topology;
}

}  // namespace

Primitive build_family_primitive(std::string_view name) {
  const FamilySpec* spec = find_family(name);
  assert(spec != nullptr);
  const Random root(kSeed);
  std::vector<std::vector<Eigen::Vector3d>> members;
  std::vector<Eigen::Vector3d> sizes_m;
  FamilyInstance instance;
  for (int m = 0; m < kMembers; ++m) {
    Random random = root.fork(static_cast<std::uint64_t>(m));
    instance = sample_family(name, random);
    for (auto& v : instance.mesh.vertices) v = v.cwiseQuotient(instance.size_m);
    members.push_back(instance.mesh.vertices);
    sizes_m.push_back(instance.size_m);
  }
  Primitive primitive;
  primitive.name = name;
  primitive.class_name = spec->class_name;
  primitive.aliases = spec->aliases;
  primitive.symmetry = spec->symmetry;
  primitive.genus = spec->genus;
  primitive.hollow = spec->hollow;
  average_shapes(members, kModes, primitive);
  average_sizes(sizes_m, primitive);
  const auto topology = family_topology(instance);
  primitive.topology = topology;
  limit_modes(primitive);

  const TriangleMesh typical{shape(primitive, primitive.typical_size_m()), topology->triangles};
  const PointTyping typing = type_points(typical);
  topology->types = typing.types;
  topology->hash = topology_hash(*topology);
  primitive.features = typing.features;
  primitive.stable_poses = find_stable_poses(typical, spec->symmetry, {.upright_share = spec->upright_share});
  primitive.contact_pairs = sample_contact_pairs(typical);
  primitive.rest_edge_length = mean_edge_length(typical);
  primitive.provenance = {"family " + std::string(name), "Apache-2.0", kMembers};
  primitive.content_hash = content_hash(primitive);
  return primitive;
}

}  // namespace gfp
