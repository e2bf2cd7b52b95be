#pragma once

#include <cstdint>
#include <vector>

#include "cli/canvas.hpp"
#include "gfp/core/camera_model.hpp"
#include "gfp/core/mesh.hpp"
#include "gfp/core/raster.hpp"
#include "gfp/grasp/grasp.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// A mesh to be painted, in the camera frame of the picture.
struct PaintedMesh {
  TriangleMesh mesh;
  std::vector<bool> observed;  ///< Per vertex; empty: all of it.
  Rgb8 color;
};

PaintedMesh painted(const FittedModel& model, const Transform& T_view_camera, Rgb8 color);

/// Paints 3-D things as one camera sees them: a z-buffer for the meshes, and lines on top.
class Painter {
 public:
  /// `camera` has the canvas's size.
  Painter(Canvas& canvas, CameraModel camera) : canvas_(canvas), camera_(std::move(camera)) {}

  /// Shaded, semi-transparent, with outline and wireframe; what was inferred is hatched. Where `measured_m` (0: nothing)
  /// is nearer than the mesh, the mesh is paler: something stands before it.
  void meshes(const std::vector<PaintedMesh>& meshes, double alpha, const Image<float>& measured_m = {});
  /// Clipped at 5 cm before the camera.
  void line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb8 color, double thickness_px = 1, double alpha = 1);
  void dot(const Eigen::Vector3d& point, double radius_px, Rgb8 color, double alpha = 1);
  void support(const SupportPlane& plane, const Transform& T_view_camera, Rgb8 color);
  /// Two fingers, palm, stem and contacts.
  void grasp(const Grasp& grasp, const Gripper& gripper, const Transform& T_view_camera, Rgb8 color, bool bold);

  const CameraModel& camera() const { return camera_; }

 private:
  void shade(const std::vector<PaintedMesh>& meshes, const DepthTile& tile, double alpha, const Image<float>& measured_m);
  void wireframe(const PaintedMesh& mesh, const DepthTile& tile);

  Canvas& canvas_;
  CameraModel camera_;
};

}  // namespace gfp
