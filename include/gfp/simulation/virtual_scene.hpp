#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/mesh.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// A known object in a known place.
struct PlacedMesh {
  std::string name;         ///< As in `mug_03`.
  std::string class_name;
  TriangleMesh mesh;        ///< Object frame, metres.
  Transform T_world_object = Transform::Identity();
  Rgb8 color{180, 180, 180};
};

/// World frame: z up, the table's surface is z = 0.
struct VirtualScene {
  std::vector<PlacedMesh> objects;
  double table_half_x_m = 0.6, table_half_y_m = 0.4;  ///< Centred on the origin.
  double floor_z_m = -0.74;
  double wall_y_m = 1.6;     ///< A wall behind the table (plane y = wall_y_m); infinity for none.
};

/// What a perfect sensor would know about one frame.
struct FrameTruth {
  Image<std::int32_t> labels;              ///< -1 background, -2 table, else index into objects.
  Image<float> depth_m;                    ///< Without noise; 0 where nothing.
  Transform T_world_camera = Transform::Identity();
  std::vector<Transform> T_camera_object;  ///< Per object.
};

}  // namespace gfp
