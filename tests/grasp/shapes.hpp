#pragma once

#include "gfp/core/mesh.hpp"
#include "gfp/grasp/plan_grasps.hpp"

namespace gfp::test {

/// Closed, outward meshes, object frame: z up, base at z = 0, metres.
TriangleMesh box_mesh(const Eigen::Vector3d& size_m, int cells = 6);
TriangleMesh cylinder_mesh(double radius_m, double height_m, int segments = 32, int rings = 8);
TriangleMesh sphere_mesh(double radius_m, int segments = 32, int rings = 16);
/// A cup: outer and inner wall, floor as thick as the wall.
TriangleMesh cup_mesh(double radius_m, double height_m, double wall_m, int segments = 32);
/// A ring that stands on its side like a mug's handle: tube of `tube_m` radius around a circle of `radius_m`, in the x-z plane.
TriangleMesh ring_mesh(double radius_m, double tube_m, int segments = 32, int sides = 12);
TriangleMesh cone_mesh(double radius_m, double height_m, int segments = 32);

/// A fit that is the truth: the mesh standing on the support plane 0.7 m in front of a camera that looks 35 degrees down.
FittedModel fit_of(const TriangleMesh& mesh, double sigma_m = 0);
Transform camera_from_support();
GraspScene table_scene();

}  // namespace gfp::test
