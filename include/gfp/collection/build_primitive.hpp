#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "gfp/collection/model_collection.hpp"
#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

struct BuildPrimitiveOptions {
  int vertices = 600;          ///< Of the primitive, about.
  int voxels = 80;             ///< Along a model's longest side, when it is made a closed surface.
  double max_residual = 0.03;  ///< Of a member: mean distance between it and the morphed template, as a share of its longest side.
  double upright_share = 0.8;  ///< How often things of the class are found standing as modelled.
};

template <class Visitor>
void visit_fields(BuildPrimitiveOptions& o, Visitor&& field) {
  field("vertices", o.vertices, 100, 5000);
  field("voxels", o.voxels, 24, 256);
  field("max_residual", o.max_residual, 0.001, 1.0);
  field("upright_share", o.upright_share, 0.0, 1.0);
}

/// What became of one model.
struct MemberReport {
  std::string name;
  std::string rejected;      ///< Why it was left out; empty: it is part of the average.
  double residual = 0;       ///< As BuildPrimitiveOptions::max_residual; 0 where it did not get that far.
  int genus = 0;
  double volume_m3 = 0;      ///< Of the closed surface.
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  TriangleMesh surface;      ///< Closed, turned as the primitive is; else as the model stood. Empty where it could not be closed.
};

struct BuiltPrimitive {
  Primitive primitive;
  std::vector<MemberReport> members;  ///< As given.
  std::size_t template_member = 0;    ///< The one that was morphed onto the others.
  double mean_moved = 0;              ///< How far the mean was kept from the plain average where that crosses itself: at most, canonical units.
};

/// A generic primitive from models of one class (P5, P6): each is made one closed surface; those of another genus than most are left out;
/// the others are turned about z until they agree with the most typical one, which is morphed onto all of them; those that it does not
/// reach are left out (where it does not reach all well, the next typical ones are tried too, and the best is taken); the rest is averaged,
/// with copies turned and mirrored as the class allows.
/// The mean shape's mirror plane becomes y = 0 and what reaches out goes to +x; the middle of its base is the origin.
/// At most members - 1 modes; few members leave wide priors. A cavity makes it hollow, with a lid on its rim. Symmetry is measured, not told.
///
/// A model that could not even be read is a member with a reason.
/// `progress(done, of)` is called from any thread, one call at a time. A requested stop ends it soon.
/// Errors: kTooFewPoints where several models leave fewer than two members, or a single one none, saying what became of each;
/// kTimeout when stopped. Deterministic at any thread count. Cost: about a second a model.
/// @param members  if given, what became of the models, also where the class is refused.
Result<BuiltPrimitive> build_primitive(const std::string& name, const std::vector<CollectionModel>& models, const BuildPrimitiveOptions& options = {},
                                       const std::function<void(int done, int of)>& progress = {}, const std::stop_token& stop = {},
                                       std::vector<MemberReport>* members = nullptr);

}  // namespace gfp
