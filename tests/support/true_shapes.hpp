#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "gfp/evaluation/metrics.hpp"
#include "gfp/simulation/virtual_scene.hpp"

namespace gfp::test {

using TrueShapes = std::vector<std::shared_ptr<const TruthShape>>;

/// What the objects of a virtual scene are, ready to be compared with fits; empty where one has no volume.
inline TrueShapes true_shapes(const VirtualScene& scene) {
  TrueShapes shapes;
  for (const PlacedMesh& object : scene.objects) {
    auto shape = make_truth_shape(object.name, object.class_name, object.mesh);
    if (!shape) return {};
    shapes.push_back(std::make_shared<const TruthShape>(std::move(*shape)));
  }
  return shapes;
}

/// How well a fit fills the true object.
inline double filled_iou(const std::shared_ptr<const TruthShape>& shape, const Transform& T_camera_object, const FittedModel& model) {
  return measure_fit({shape, T_camera_object, std::vector<std::uint8_t>(shape->samples.points.size(), 1)}, model, {}).iou_filled;
}

}  // namespace gfp::test
