#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// What may differ without being a difference.
struct DiffTolerances {
  double position_m = 0.001;
  double angle_rad = 0.01;
  double size_m = 0.001;
  double vertex_m = 0.001;        ///< Largest distance of equal vertices.
  double width_m = 0.001;         ///< Of a grasp's opening.
  double epsilon = 0.01;          ///< Of a grasp's quality.
  bool grasps = true;
};

/// One object as far as it is compared; what a source does not tell is empty.
struct DiffObject {
  std::uint64_t id = 0;
  std::string class_name, method;
  Transform T_camera_object = Transform::Identity();
  Eigen::Vector3d extents_m = Eigen::Vector3d::Zero();
  std::uint64_t topology = 0;
  std::vector<Eigen::Vector3d> vertices;  ///< Object frame.
  std::vector<Grasp> grasps;              ///< Pose, width and epsilon.
  std::string no_grasp_reason;
};

struct DiffFrame {
  std::string sensor;
  Nanoseconds stamp{};
  std::vector<DiffObject> objects;
};

/// One thing that differs: `pose` of object 3, 12.5 mm instead of at most 1 mm.
struct Difference {
  std::size_t frame = 0;                    ///< Number in A (in B where A has not got it).
  Nanoseconds stamp{};
  std::optional<std::uint64_t> id_a, id_b;  ///< Empty: it is not there.
  std::string what;                         ///< frame, object, class, method, position, angle, size, topology, vertices, grasps, no_grasp_reason.
  std::string a, b;                         ///< As they are, for a person.
  double delta = 0, tolerance = 0;          ///< 0 where there is no measure.
};

/// The scenes of an .mcap recording, or of JSON lines as `gfp fit --json` and `gfp sub --json` print them (without vertices).
/// Errors: as McapReader, kUnsupported (no scenes in it), kCorruptData naming the line.
Result<std::vector<DiffFrame>> load_scenes(const std::filesystem::path& file);

/// Frames are matched by stamp, objects by place: those nearest to each other, at most 10 cm apart.
std::vector<Difference> compare_scenes(const std::vector<DiffFrame>& a, const std::vector<DiffFrame>& b, const DiffTolerances& tolerances);

}  // namespace gfp
