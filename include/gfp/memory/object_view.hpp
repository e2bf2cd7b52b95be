#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/image.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// What a pixel near an object says about the object.
enum class Evidence : std::uint8_t {
  kUnknown,    ///< No reading: nothing is known (glass, shadow, outside the cloud).
  kObject,     ///< Belongs to the object's cluster: the surface is here.
  kSupport,    ///< Its support plane: nothing of the object may be in front of it.
  kBackground, ///< Something farther than the object: free space up to that depth.
  kOther,      ///< Another object: whether it hides ours depends on its depth.
};

struct FittedModel;  // of the step `modelling`: carried to the next frame, never looked into by `memory`

/// What the last frame knew of this object; lets the fit skip its search.
struct WarmStart {
  std::string primitive;                ///< Its name; empty for methods without one.
  std::string method;
  Transform T_camera_object = Transform::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::vector<double> modes;
  int stable_pose = 0;
  int unchanged_frames = 0;
  double cost = std::numeric_limits<double>::infinity();  ///< FitEvidence::cost of that fit: a warm fit that got worse is searched anew.
  int fits = 0;                         ///< So far; every now and then one of them searches anew.
  std::shared_ptr<const FittedModel> model;  ///< That fit itself; its pose is in the camera frame of its own frame.
};

struct ObjectView;

/// The same object as it was seen from elsewhere: by another sensor, or by this one before it moved.
struct Sighting {
  Transform T_sighting_camera = Transform::Identity();  ///< Maps the camera frame of the view that holds this into the sighting's.
  std::shared_ptr<const ObjectView> view;               ///< Its own `field` is empty.
};

/// All that one object's fit may look at: a copy of its part of the frame, cut out with a margin.
/// The tile has the frame's resolution: tile pixel (i, j) is image pixel (tile.u0 + i, tile.v0 + j).
struct ObjectView {
  std::uint64_t id = 0;                 ///< Persistent over frames.
  int segment = -1;                     ///< Index into the frame's Segments.
  CameraModel camera;
  SensorNoise noise;
  Transform T_camera_support = Transform::Identity();
  bool has_support = false;             ///< False: T_camera_support is only a guess of "up", its origin at the lowest point.
  PixelRect tile;
  Image<float> depth_m;                 ///< z in metres, 0 where there is no reading.
  Image<Evidence> evidence;
  Image<Eigen::Vector3f> normals;       ///< Camera frame, towards the camera; (0, 0, 0) where none. kObject pixels only.
  int object_pixels = 0;
  bool touches_border = false, occluded = false, top_cut = false;
  double height_m = 0;                  ///< 99.5 % quantile above the support.
  std::vector<std::vector<Eigen::Vector2d>> neighbour_footprints;  ///< Convex outlines on the support plane of the other clusters, support frame.
  std::vector<Sighting> field;          ///< What else was seen of it, as far as it still holds: `robust` fits look at all of it.
  std::optional<WarmStart> warm_start;
  bool unchanged = false;               ///< Within noise it looks as it did when it was fitted: that fit still holds.
};

}  // namespace gfp
