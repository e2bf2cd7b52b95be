#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/evaluation/truth.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// A frame and where it shows the object.
struct MaskedFrame {
  Frame frame;
  Image<std::uint8_t> object_mask;  ///< Non-zero where the frame shows the object.
};

/// One known object in one frame: what the methods see and what is true.
struct EvaluationCase : MaskedFrame {
  std::vector<MaskedFrame> elsewhere;  ///< The object from other standpoints: for methods that use the object's field.
  TruthView truth;
  double hidden_share = 0;          ///< Share of the object's pixels that something nearer hides.
  std::vector<Eigen::Vector3f> others_camera;     ///< Surface points of what else stands there, metres; for judging grasps.
  std::optional<Transform> T_camera_support;      ///< The true table; empty where nobody measured it.
};

/// A case that can be made when its turn comes: thousands of frames would not fit into memory.
struct CaseSpec {
  std::string source;      ///< `meshes`, `families` or `frames`.
  std::string object;      ///< As in `mug/ycb_mug`.
  std::string view;        ///< As in `e20 y135`: elevation and yaw in degrees; or the frame's name.
  std::string class_name;  ///< As labelled; `other` where the object has none.
  std::function<Result<EvaluationCase>()> make;  ///< Pure and safe from any thread.
};

struct CaseOptions {
  int views = 4;                                    ///< Yaws per object and elevation.
  std::vector<double> elevations_deg{20, 35, 60};
  int cameras = 1;                                  ///< Standpoints whose views are fitted together, evenly around the object; of posed frames so many of them.
  double occlusion = 0;                             ///< Share of the object's pixels that a nearer box hides.
  double noise_scale = 1;                           ///< Of the virtual Kinect's errors; 0: a perfect camera.
  double distance_m = 0.8;                          ///< From the camera to the object's centre.
  int instances = 3;                                ///< Members per family.
  double free_form = 0.02;                          ///< Of families: smooth random displacement, share of the size.
  std::string only;                                 ///< Non-empty: only objects whose `class object` holds this text.
  std::uint64_t seed = 1;
  TruthOptions truth;

  bool wants(const std::string& class_name, const std::string& object) const { return only.empty() || (class_name + " " + object).find(only) != std::string::npos; }
};

/// The cases of a folder, known by its files: meshes with a meshes.csv, or posed real frames with a poses.json.
/// Errors: kNotFound (neither, or a file it names), kCorruptData (a table or mesh that breaks its format; names file and line).
Result<std::vector<CaseSpec>> list_folder_cases(const std::filesystem::path& folder, const CaseOptions& options = {});

/// Points all over a mesh, close enough together that no gripper part slips between them: input of EvaluationCase::others_camera.
void append_surface_points(const TriangleMesh& mesh_camera, std::vector<Eigen::Vector3f>& points);

/// Meshes on a table before a virtual camera. `meshes.csv` has a header with at least the columns file, class, scale_to_m and
/// up_axis (x, y or z). A file named *_pair holds several objects, told apart as groups of connected parts. A hollow thing whose
/// cavity opens along another axis than up_axis is stood up on that axis; its name says `(turned)`.
Result<std::vector<CaseSpec>> list_mesh_cases(const std::filesystem::path& folder, const CaseOptions& options = {});

/// Real frames with known meshes in known places. `poses.json` maps a frame's name to {K, depth_units_per_m, objects[{label_value,
/// class, mesh (below ../..), mesh_to_camera}]}; beside it lie <frame>-depth.png and <frame>-label.png. The meshes are z-up metres.
Result<std::vector<CaseSpec>> list_posed_cases(const std::filesystem::path& folder, const CaseOptions& options = {});

/// Members of the parametric families that no primitive was made of: other seeds, another tessellation, free-form displacement.
Result<std::vector<CaseSpec>> list_family_cases(const CaseOptions& options = {});

}  // namespace gfp
