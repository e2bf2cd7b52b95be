#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// P6: control points form the frame and are placed by scene data, regular points follow and smooth.
enum class PointType : std::uint8_t { kRegular, kControl };

/// What a vertex belongs to; a handle is a part of its own, an inner wall is never the outside of anything.
enum class Part : std::uint8_t { kBody, kBase, kRim, kInnerWall, kHandle, kNeck, kCap, kSpout };

/// Symmetries of the canonical shape. Mirror planes contain the z axis.
struct Symmetry {
  bool revolution = false;  ///< About z: yaw means nothing.
  int cyclic = 1;           ///< Shape repeats every 2 pi / cyclic about z.
  bool mirror_x = false;    ///< Plane x = 0: (x, y, z) -> (-x, y, z).
  bool mirror_y = false;    ///< Plane y = 0.
  bool flip_z = false;      ///< Upside down it looks the same (box, can).
};

/// A way in which the object rests on a plane.
struct StablePose {
  Eigen::Matrix3d R_support_object = Eigen::Matrix3d::Identity();  ///< Turns the object frame so that it rests; yaw is free.
  double probability = 1;  ///< Prior: share of table objects found like this.
  std::string name;        ///< `upright`, `inverted`, `lying`...
};

/// Two surface points that oppose each other (ALGORITHM 5), without a gripper: carried by any deformation.
struct ContactPair {
  std::int32_t face[2];
  Eigen::Vector3d barycentric[2];
};

/// Connectivity shared by all fits of a primitive: sent once by its content hash.
struct Topology {
  std::vector<Triangle> triangles;         ///< The closed surface.
  std::vector<Triangle> filled_triangles;  ///< The same vertices with every cavity closed at its rim; equal to `triangles` for solid bodies.
  std::vector<PointType> types;            ///< Per vertex; the manual layer is already applied.
  std::vector<Part> parts;                 ///< Per vertex.
  std::uint64_t hash = 0;                  ///< First 8 bytes of a SHA-256 over all of the above.
};

/// Where a shape came from and under which terms it may be used.
struct Provenance {
  std::string source;   ///< `family mug`, or the folder it was built from.
  std::string licence;
  int members = 0;      ///< Shapes averaged.
};

/// How a primitive looks: descriptors of rendered views (recognition/train_views.hpp), row after row.
struct TrainingViews {
  int descriptor_size = 0;
  std::vector<std::int32_t> stable_pose;  ///< Per view.
  std::vector<float> descriptors;         ///< Views x descriptor_size.
};

/// The Generic Fitted Primitive (P6-P8): a class's mean shape, how it varies, and how it rests.
///
/// Canonical frame: z up, origin at the base centre, divided per axis by the reference size, so that
///     p_object = size_m * (mean + sum_k b_k modes[k])   (component-wise product, metres, b ~ N(0, I)).
struct Primitive {
  static constexpr std::uint32_t kSchemaVersion = 1;

  std::string name;                                    ///< Unique in a library; the class's own name where one shape suffices.
  std::string class_name;                              ///< Round and flat bottles are primitives of one class.
  std::vector<std::string> aliases;                    ///< Other names users give it (glass = cup).
  std::vector<Eigen::Vector3d> mean;                   ///< N canonical points (M).
  std::shared_ptr<const Topology> topology;            ///< A and W.
  std::vector<std::vector<Eigen::Vector3d>> modes;     ///< K x N canonical displacements for one standard deviation, strongest first.
  std::vector<double> mode_sigma;                      ///< RMS displacement of one standard deviation, canonical units (for people).
  Eigen::Vector3d log_size_mean = Eigen::Vector3d::Zero();        ///< Mean of log(reference size in metres).
  Eigen::Matrix3d log_size_covariance = Eigen::Matrix3d::Identity();
  double residual_sigma = 0.01;                        ///< What the modes do not explain: RMS, canonical units, for unseen parts.
  Symmetry symmetry;
  int genus = 0;
  bool hollow = false;                                 ///< Has a cavity that a camera looks into.
  std::vector<StablePose> stable_poses;                ///< Most probable first.
  std::vector<ContactPair> contact_pairs;
  std::vector<std::optional<PointType>> manual_types;  ///< Per vertex: a person's override (P7), kept apart from the automatic layer; empty or N.
  double rest_edge_length = 0;                         ///< Mean edge length of the mean shape at the mean size, metres.
  int features = 0;                                    ///< P6 "number of features": sharp corners and curvature extremes found by typing.
  Provenance provenance;
  TrainingViews training_views;                        ///< Derived from the rest; empty: recognition renders them at first use.
  std::uint64_t content_hash = 0;                      ///< First 8 bytes of a SHA-256 over the rest but `training_views`.

  Eigen::Vector3d typical_size_m() const { return log_size_mean.array().exp().matrix(); }
  std::size_t size() const { return mean.size(); }
};

using PrimitivePtr = std::shared_ptr<const Primitive>;

/// Vertices in the object frame, metres: size_m * (mean + sum b_k modes[k]). `modes` may be shorter than the primitive's.
std::vector<Eigen::Vector3d> shape(const Primitive& primitive, const Eigen::Vector3d& size_m, const std::vector<double>& modes = {});

}  // namespace gfp
