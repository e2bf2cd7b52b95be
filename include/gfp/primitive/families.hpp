#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// One member of a parametric class: a closed, oriented, intersection-free mesh, object frame (z up, base at z = 0), metres.
struct FamilyInstance {
  std::string class_name;
  TriangleMesh mesh;
  std::vector<Triangle> filled_triangles;  ///< Same vertices, cavity closed at the rim.
  std::vector<Part> parts;                 ///< Per vertex.
  Eigen::Vector3d size_m;                  ///< Reference size (for a mug: of the body, without its handle).
};

struct SampleFamilyOptions {
  double spread = 1.0;       ///< Of the parameters around the class's mean; 0 gives the mean member.
  double resolution = 1.0;   ///< Tessellation relative to the primitive's; 1 gives the primitive's own connectivity.
  double free_form = 0.0;    ///< Amplitude of a smooth random displacement, share of the size: the test is then not the model.
};

/// Names of all families, sorted. A class may have several: round and flat bottles.
std::vector<std::string> family_names();
FamilyInstance sample_family(std::string_view name, Random& random, const SampleFamilyOptions& options = {});

/// The GFP of a family: mean, modes, size prior, typing, symmetry, stable poses, contact pairs. Deterministic.
Primitive build_family_primitive(std::string_view name);

}  // namespace gfp
