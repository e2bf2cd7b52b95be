#include <cassert>
#include <numbers>

#include "gfp/core/sha256.hpp"
#include "gfp/primitive/families.hpp"
#include "primitive/family_shape.hpp"
#include "primitive/shape_modes.hpp"

namespace gfp {
namespace {

constexpr int kMembers = 160;
constexpr int kModes = 8;
constexpr std::uint64_t kSeed = 42;

std::vector<StablePose> stable_poses(const FamilySpec& spec) {
  const auto turned = [](double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix(); };
  const double rest = 1.0 - spec.upright_share;
  std::vector<StablePose> poses{{Eigen::Matrix3d::Identity(), spec.upright_share, "upright"}};
  if (!spec.symmetry.flip_z) poses.push_back({turned(std::numbers::pi), 0.5 * rest, "inverted"});
  poses.push_back({turned(0.5 * std::numbers::pi), spec.symmetry.flip_z ? rest : 0.5 * rest, "lying"});
  return poses;
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
  primitive.class_name = name;
  primitive.aliases = spec->aliases;
  primitive.symmetry = spec->symmetry;
  primitive.genus = spec->genus;
  primitive.hollow = spec->hollow;
  average_shapes(members, kModes, primitive);
  average_sizes(sizes_m, primitive);
  primitive.stable_poses = stable_poses(*spec);
  Topology topology;
  topology.triangles = instance.mesh.triangles;
  topology.filled_triangles = instance.filled_triangles;
  topology.types.assign(primitive.mean.size(), PointType::kControl);
  topology.parts = instance.parts;
  topology.hash = std::hash<std::string_view>{}(name);
  primitive.content_hash = topology.hash;
  primitive.rest_edge_length = mean_edge_length({shape(primitive, primitive.typical_size_m()), topology.triangles});
  primitive.topology = std::make_shared<const Topology>(std::move(topology));
  primitive.provenance = {"family " + std::string(name), "Apache-2.0", kMembers};
  return primitive;
}

}  // namespace gfp
