#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/evaluation/surface_samples.hpp"
#include "gfp/evaluation/triangle_tree.hpp"
#include "gfp/evaluation/voxel_solid.hpp"

namespace gfp {

/// A known object, with all that its comparison with fits needs; made once and shared by all its views.
struct TruthShape {
  std::string name;                      ///< As in `mug/ycb_mug`.
  std::string class_name;                ///< As labelled; `other` where it has none.
  TriangleMesh mesh;                     ///< Object frame: z up, base centre at the origin; oriented outwards; metres.
  /// Where the mesh's frame is its class's canonical one: the shape repeats every so many radians of yaw (2 pi / cyclic).
  std::optional<double> yaw_period_rad;
  TriangleTree tree;
  SurfaceSamples samples;                ///< Of the surface that can be reached from outside.
  FilledSolid solid;
  double volume_filled_m3 = 0;
};

struct TruthOptions {
  double voxel_m = 0.001;
  int samples = 4000;
  std::uint64_t seed = 1;
};

/// Errors: those of fill_solid; kDegenerateGeometry where the mesh has no area.
Result<TruthShape> make_truth_shape(std::string name, std::string class_name, TriangleMesh mesh, const TruthOptions& options = {});

/// One known object in one view.
struct TruthView {
  std::shared_ptr<const TruthShape> shape;
  Transform T_camera_object = Transform::Identity();
  std::vector<std::uint8_t> visible;  ///< Per sample of the shape: whether the camera sees it, past itself and all else.
};

/// Which samples of `shape` the camera sees: inside the image, and no mesh of the scene in between.
/// `others_camera`: what else stands in the scene, camera frame.
std::vector<std::uint8_t> visible_samples(const TruthShape& shape, const Transform& T_camera_object, const CameraModel& camera,
                                          const std::vector<TriangleTree>& others_camera);

}  // namespace gfp
