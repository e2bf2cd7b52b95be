#include <cassert>

#include "gfp/primitive/families.hpp"
#include "gfp/primitive/primitive_of_members.hpp"
#include "primitive/family_shape.hpp"

namespace gfp {
namespace {

constexpr int kMembers = 200;
constexpr std::uint64_t kSeed = 42;

}  // namespace

Primitive build_family_primitive(std::string_view name) {
  const FamilySpec* spec = find_family(name);
  assert(spec != nullptr);
  const Random root(kSeed);
  ClassMembers members;
  for (int m = 0; m < kMembers; ++m) {
    Random random = root.fork(static_cast<std::uint64_t>(m));
    FamilyInstance instance = sample_family(name, random);
    members.shapes.push_back(std::move(instance.mesh.vertices));
    members.sizes_m.push_back(instance.size_m);
    members.triangles = std::move(instance.mesh.triangles);  // the same for all
    members.filled_triangles = std::move(instance.filled_triangles);
    members.parts = std::move(instance.parts);
  }
  return primitive_of_members(members, {.name = std::string(name),
                                        .class_name = std::string(spec->class_name),
                                        .aliases = spec->aliases,
                                        .symmetry = spec->symmetry,
                                        .genus = spec->genus,
                                        .hollow = spec->hollow,
                                        .upright_share = spec->upright_share,
                                        .provenance = {"family " + std::string(name), "Apache-2.0", kMembers}});
}

}  // namespace gfp
