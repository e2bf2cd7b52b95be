#pragma once

#include <Eigen/Dense>
#include <limits>
#include <span>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/raster.hpp"
#include "gfp/core/residual_rows.hpp"
#include "gfp/memory/image_score.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The unknowns of a fit. Tangent order: x y z, rx ry rz (about the object's origin, support axes), log size 3, modes.
struct PoseState {
  Transform T_support_object = Transform::Identity();
  Eigen::Vector3d log_size = Eigen::Vector3d::Zero();
  Eigen::VectorXd modes;
  double largest_mode = std::numeric_limits<double>::infinity();  ///< Bound of their absolute values.

  static constexpr int kPose = 6, kShape = kPose + 3;
  int unknowns() const { return kShape + static_cast<int>(modes.size()); }
  void apply(const Eigen::VectorXd& step);
};

/// How tight the fit looks at the data; annealed from coarse to fine.
struct FitScale {
  double robust_m = 0.01;      ///< Residuals beyond this lose their say.
  double model_sigma_m = 0.002;///< What the class's shape cannot follow, added to the sensor's noise.
  double tilt_sigma_rad = 0.02;
  double contact_sigma_m = 0.0015;
};

/// What a fit is compared with: the observation, and where its silhouette should be drawn in to.
struct SearchTile : ObservedTile {
  explicit SearchTile(ObservedTile observed);
  std::vector<std::uint8_t> rim;             ///< 1 for an object cell beside one that is none: the object's own silhouette, or where it is cut.
};

/// One tile a view of the object: its own, then those of its field.
std::vector<SearchTile> search_tiles(const ObjectView& view, int target_cells);

/// Compares what was seen of one object, from one standpoint or several, with the visible part of a posed primitive, and improves the pose (ALGORITHM 1.3-1.5).
///
/// Four kinds of residuals: point-to-plane at object pixels that the model covers; the model's silhouette drawn out to object
/// pixels that it leaves bare; drawn in from pixels where the sensor saw past it; the lowest vertex on the table. The class prior
/// on size and modes closes the system. One thread at a time; holds references to its arguments.
class VisibleFit {
 public:
  /// `tiles`: at least one, the object's own view first.
  VisibleFit(std::span<const SearchTile> tiles, const Primitive& primitive, bool has_support);

  /// Poses and renders `state`; the functions below speak of it.
  void pose(const PoseState& state);

  /// Mean capped negative log likelihood over the object's pixels and those where the model stands in free space, of all views.
  double score(double model_sigma_m = kModelSigmaM) const;

  /// Residuals of the posed state -> Gauss-Newton step with Levenberg damping. `information` is the undamped normal matrix.
  Eigen::VectorXd step(const FitScale& scale, double damping);
  const Eigen::MatrixXd& information() const { return information_; }

  /// Mean difference observed - rendered over the points that the first view shows, support frame; zero where nothing is covered.
  Eigen::Vector3d visible_centroid_shift() const;

  /// The same over the cells that both cover, along the rays: how far in front of the model the readings are there.
  Eigen::Vector3d overlap_shift() const;

  const PoseState& state() const { return state_; }
  Bounds bounds_support() const;

 private:
  struct SurfacePoint;

  /// The model as one view shows it.
  struct Rendering {
    const SearchTile* tile;
    Eigen::Vector3d camera_support;              ///< The camera's centre.
    std::vector<Eigen::Vector3d> camera;         ///< Vertices, in that camera's frame.
    DepthTile depth;

    Eigen::Vector3d point_support(int cell) const;  ///< Of the model, where it was hit.
  };

  SurfacePoint surface_point(const Rendering& seen, int cell) const;
  SurfacePoint vertex_point(std::size_t vertex) const;
  Eigen::Vector3d support_point(std::size_t vertex) const;
  void add(const SurfacePoint& point, const Eigen::Vector3d& direction, double residual, double weight);
  void add_surface_residuals(const Rendering& seen, const FitScale& scale);
  void add_silhouette_residuals(const Rendering& seen, const FitScale& scale);
  void add_contact_and_priors(const FitScale& scale);

  const Primitive& primitive_;
  bool has_support_;
  Eigen::Matrix3d size_information_;

  PoseState state_;
  Eigen::Vector3d size_ = Eigen::Vector3d::Ones();
  Eigen::Matrix3d support_linear_ = Eigen::Matrix3d::Identity();  ///< Rotation * size: canonical to support frame, but for the offset.
  std::vector<Eigen::Vector3d> canonical_;
  std::vector<Rendering> renderings_;            ///< One a tile.
  ResidualRows rows_;
  std::vector<double> weights_;                  ///< Of the rows.
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
};

}  // namespace gfp
