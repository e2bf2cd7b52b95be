#include "gfp/primitive/primitive_of_members.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gfp/core/self_intersections.hpp"
#include "gfp/primitive/contact_pairs.hpp"
#include "gfp/primitive/content_hash.hpp"
#include "gfp/primitive/stable_poses.hpp"
#include "gfp/primitive/type_points.hpp"
#include "primitive/shape_modes.hpp"

namespace gfp {
namespace {

constexpr int kModes = 8;
constexpr double kCheckedSigma = 2.0;  // the mean moved this far along any mode crosses itself nowhere

bool crosses_itself(const Primitive& primitive, const std::vector<double>& modes) {
  return count_self_intersections({shape(primitive, primitive.typical_size_m(), modes), primitive.topology->triangles}, 1) > 0;
}

/// Shrinks a mode until the mean +- 2 sigma is free of intersections: the classes' parameters are not quite linear. False: nothing is left of it.
bool limit_mode(Primitive& primitive, std::size_t k) {
  constexpr double kStep = 0.85;
  constexpr int kSteps = 20;  // to 4 %
  std::vector<double> plus(k + 1, 0.0), minus(k + 1, 0.0);
  plus[k] = kCheckedSigma;
  minus[k] = -kCheckedSigma;
  for (int step = 0; step < kSteps; ++step) {
    if (!crosses_itself(primitive, plus) && !crosses_itself(primitive, minus)) return true;
    for (auto& displacement : primitive.modes[k]) displacement *= kStep;
    primitive.mode_sigma[k] *= kStep;
  }
  return false;
}

/// Holds a mode back where the mean moved along it crosses itself, and leaves it elsewhere: at the rims of thin walls, mostly.
void damp_modes(Primitive& primitive) {
  constexpr int kRounds = 3;  // damping one way may open a crossing the other way
  for (std::size_t k = 0; k < primitive.modes.size(); ++k) {
    auto& mode = primitive.modes[k];
    for (int round = 0; round < kRounds; ++round) {
      for (const double sigma : {kCheckedSigma, -kCheckedSigma}) {
        std::vector<Eigen::Vector3d> wanted = primitive.mean;
        for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] += sigma * mode[i];
        const Approach moved = approach_without_crossing(primitive.mean, wanted, primitive.topology->triangles);
        for (std::size_t i = 0; i < mode.size(); ++i) mode[i] *= moved.share[i];
      }
    }
    double squared = 0;
    for (const auto& displacement : mode) squared += displacement.squaredNorm();
    primitive.mode_sigma[k] = std::sqrt(squared / static_cast<double>(mode.size()));
  }
}

void limit_modes(Primitive& primitive) {
  for (std::size_t k = 0; k < primitive.modes.size();) {
    if (limit_mode(primitive, k)) {
      ++k;
      continue;
    }
    primitive.modes.erase(primitive.modes.begin() + static_cast<std::ptrdiff_t>(k));
    primitive.mode_sigma.erase(primitive.mode_sigma.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// A class known from few members is wider than they show.
void widen(double weight, int members, Primitive& primitive) {
  constexpr double kSizeSigma = 0.15, kResidualSigma = 0.02;
  const double known = static_cast<double>(members - 1), all = known + weight;
  primitive.log_size_covariance = (known * primitive.log_size_covariance + weight * kSizeSigma * kSizeSigma * Eigen::Matrix3d::Identity()) / all;
  primitive.residual_sigma = std::sqrt((known * primitive.residual_sigma * primitive.residual_sigma + weight * kResidualSigma * kResidualSigma) / all);
}

std::vector<std::vector<Eigen::Vector3d>> canonical(const ClassMembers& members) {
  std::vector<std::vector<Eigen::Vector3d>> shapes = members.shapes;
  for (std::size_t m = 0; m < shapes.size(); ++m)
    for (auto& v : shapes[m]) v = v.cwiseQuotient(members.sizes_m[m]);
  return shapes;
}

}  // namespace

Primitive primitive_of_members(const ClassMembers& members, const ClassFacts& facts) {
  Primitive primitive;
  primitive.name = facts.name;
  primitive.class_name = facts.class_name;
  primitive.aliases = facts.aliases;
  primitive.symmetry = facts.symmetry;
  primitive.genus = facts.genus;
  primitive.hollow = facts.hollow;
  const int count = facts.members > 0 ? facts.members : static_cast<int>(members.shapes.size());
  average_shapes(canonical(members), std::min(kModes, count - 1), primitive);
  average_sizes(members.sizes_m, primitive);
  const auto topology = std::make_shared<Topology>();
  topology->triangles = members.triangles;
  topology->filled_triangles = members.filled_triangles;
  topology->parts = members.parts;
  primitive.topology = topology;
  if (facts.doubt_members > 0) widen(facts.doubt_members, count, primitive);
  if (!members.sound.empty()) {
    std::vector<Eigen::Vector3d> sound;
    for (const auto& p : members.sound) sound.push_back(p.cwiseQuotient(members.sound_size_m));
    primitive.mean = approach_without_crossing(sound, primitive.mean, members.triangles).vertices;
    damp_modes(primitive);
  }
  limit_modes(primitive);

  const TriangleMesh typical{shape(primitive, primitive.typical_size_m()), topology->triangles};
  primitive.stable_poses = find_stable_poses(typical, facts.symmetry, {.upright_share = facts.upright_share});
  primitive.provenance = facts.provenance;
  complete_from_shape(primitive);
  return primitive;
}

void complete_from_shape(Primitive& primitive) {
  Topology topology = *primitive.topology;
  const TriangleMesh typical{shape(primitive, primitive.typical_size_m()), topology.triangles};
  const PointTyping typing = type_points(typical);
  topology.types = with_manual_types(typing.types, primitive.manual_types);
  topology.hash = topology_hash(topology);
  primitive.topology = std::make_shared<const Topology>(std::move(topology));
  primitive.features = typing.features;
  primitive.contact_pairs = sample_contact_pairs(typical);
  primitive.rest_edge_length = mean_edge_length(typical);
  primitive.content_hash = content_hash(primitive);
}

void set_manual_types(Primitive& primitive, std::vector<std::optional<PointType>> manual) {
  Topology topology = *primitive.topology;
  topology.types = with_manual_types(type_points({shape(primitive, primitive.typical_size_m()), topology.triangles}).types, manual);
  topology.hash = topology_hash(topology);
  primitive.topology = std::make_shared<const Topology>(std::move(topology));
  primitive.manual_types = std::move(manual);
  primitive.content_hash = content_hash(primitive);
}

}  // namespace gfp
