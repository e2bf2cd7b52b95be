#pragma once

#include <cstdint>

#include "gfp/simulation/virtual_scene.hpp"

namespace gfp {

/// How a structured-light camera errs (ALGORITHM 7); `scale` 0 gives a perfect one.
struct VirtualCameraOptions {
  SensorNoise noise;
  double noise_scale = 1.0;          ///< Multiplies the depth noise; 0: none of the effects below either.
  double disparity_step_px = 0.125;  ///< Quantisation of a Kinect v1's disparity (baseline 75 mm).
  double edge_jitter_px = 0.5;       ///< Silhouettes waver by this much.
  double grazing_dropout_deg = 80;   ///< No reading where the surface is seen flatter than this from its normal.
  double shadow_baseline_m = 0.075;  ///< The projector's offset to the right: what it does not reach has no reading.
};

struct Capture {
  Frame frame;
  FrameTruth truth;
};

/// Renders the scene as a depth camera at T_world_camera would see it. Deterministic for one seed.
Capture capture(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera,
                const VirtualCameraOptions& options, std::uint64_t seed);

/// The camera pose that looks at `target_world` from `distance_m`, `elevation_rad` above the horizon and `azimuth_rad` about z.
Transform look_at_pose(const Eigen::Vector3d& target_world, double distance_m, double elevation_rad, double azimuth_rad);

struct TableTopOptions {
  int objects = 5;
  double clutter = 0.0;              ///< 0: objects stand apart; 1: they touch and hide each other.
  double resting_otherwise = 0.15;   ///< Share of objects that lie or stand on their rim.
  std::vector<std::string> classes;  ///< To draw from; empty: every family.
};

/// A table with objects drawn from the families, none inside another, each at rest. Deterministic for one seed.
VirtualScene table_top_scene(const TableTopOptions& options, std::uint64_t seed);

}  // namespace gfp
