#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// State of one vertex (P27): bits.
enum VertexState : std::uint8_t {
  kVertexObserved = 1,  ///< Seen: data within its noise; otherwise inferred.
  kVertexControl = 2,   ///< Control point; otherwise regular.
  kVertexMoved = 4,     ///< Moved by data; otherwise frozen at the globally refined place.
};

/// What speaks for and against a fit; all terms are comparable between methods.
struct FitEvidence {
  double rms_m = 0;                 ///< Point-to-surface over the object's pixels, trimmed at 3 sigma of the noise + 10 mm.
  double fit_similarity = 0;        ///< P28, gamma = 1/(5 mm)^2.
  double explained = 0;             ///< Share of object pixels that the model covers within tolerance.
  double free_space_violation = 0;  ///< Share of the model's visible pixels that stand in seen free space.
  double silhouette_iou = 0;        ///< Of the model's silhouette and the mask, unknown and occluded pixels left out.
  double below_support_m = 0;       ///< Deepest vertex under the table.
  double neighbour_overlap_m = 0;   ///< Deepest reach into neighbours' footprints.
  double mahalanobis = 0;           ///< Of size and modes under the class prior.
  double context = 0;               ///< Log odds that the rest of the scene adds to the class; what `selection` found.
  double cost = 0;                  ///< The number `selection` compares: negative log evidence per effective pixel.
};

/// A closed volume for one object by one method. Object frame: z up through the base centre.
struct FittedModel {
  std::string method;                               ///< gfp_robust, superquadric...
  std::string class_name;                           ///< `unknown` where the method needs no class.
  PrimitivePtr primitive;                           ///< Null for methods without one.
  std::shared_ptr<const Topology> topology;         ///< Never null; its triangles close `vertices`.
  std::vector<Eigen::Vector3d> vertices;            ///< Object frame, metres.
  Transform T_camera_object = Transform::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones(); ///< Per-axis size of the reference shape.
  std::vector<double> modes;
  int stable_pose = 0;
  std::vector<std::uint8_t> states;                 ///< VertexState bits, per vertex.
  std::vector<float> sigma_m;                       ///< 1-sigma of each vertex along its normal, metres.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< x y z rx ry rz.
  double yaw_low_rad = 0, yaw_high_rad = 0;
  FitEvidence evidence;
  std::optional<int> self_intersections;            ///< Where the method counted them itself.
  std::vector<double> energies;                     ///< Per contour iteration (Fig. 6), J/J0-free units; may be empty.
  int iterations = 0;
  bool converged = false;

  TriangleMesh mesh_object() const { return {vertices, topology->triangles}; }
  std::vector<Eigen::Vector3d> vertices_camera() const { return transformed(vertices, T_camera_object); }
  TriangleMesh mesh_camera() const { return {vertices_camera(), topology->triangles}; }
};

}  // namespace gfp
