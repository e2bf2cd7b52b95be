#include <algorithm>
#include <utility>

#include "gfp/core/mesh.hpp"
#include "gfp/scene/remember.hpp"

namespace gfp {
namespace {

PixelRect object_box(const ObjectView& view) {
  PixelRect box{view.tile.u1, view.tile.v1, view.tile.u0, view.tile.v0};
  for (int v = view.tile.v0; v < view.tile.v1; ++v) {
    for (int u = view.tile.u0; u < view.tile.u1; ++u) {
      if (view.evidence.at(u - view.tile.u0, v - view.tile.v0) != Evidence::kObject) continue;
      box = {std::min(box.u0, u), std::min(box.v0, v), std::max(box.u1, u + 1), std::max(box.v1, v + 1)};
    }
  }
  return view.object_pixels > 0 ? box : PixelRect{};
}

}  // namespace

SceneObject describe(ObjectEstimate estimate, const ObjectView& view, ObjectStatus status) {
  SceneObject object;
  object.id = view.id;
  object.status = status;
  object.class_probabilities = std::move(estimate.class_probabilities);
  object.model = std::move(estimate.model);
  object.pixels = view.object_pixels;
  object.bbox = object_box(view);
  object.touches_border = view.touches_border;
  object.occluded = view.occluded;
  const TriangleMesh mesh = object.model.mesh_object();
  const auto& filled = object.model.topology->filled_triangles;
  object.volume_material_m3 = signed_volume(mesh);
  object.volume_filled_m3 = filled.empty() ? object.volume_material_m3 : signed_volume({mesh.vertices, filled});
  object.closed = object.model.primitive || examine_topology(mesh).closed;  // a primitive's topology was examined when it was loaded
  object.self_intersections = object.model.self_intersections ? *object.model.self_intersections : count_self_intersections(mesh);
  return object;
}

}  // namespace gfp
