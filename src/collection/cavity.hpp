#pragma once

#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The inner wall of a vessel that stands upright.
struct Cavity {
  bool found = false;
  std::vector<Part> parts;                 ///< Per vertex: kInnerWall or kBody.
  std::vector<Triangle> filled_triangles;  ///< The surface with a lid on its rim in the place of the inner wall; the whole where there is none.
};

/// Where water would stand in the shape (closed, z up), if that is a fifth of its material or more and its wall one patch with one rim.
Cavity find_cavity(const TriangleMesh& mesh);

}  // namespace gfp
