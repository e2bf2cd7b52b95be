#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "gfp/scene/scene.hpp"

namespace gfp {

/// What a Scene does not know of itself.
struct SceneJsonContext {
  std::string input;                              ///< The file, folder or endpoint the frame came from.
  std::string method;                             ///< The method that was asked for.
  std::map<std::uint64_t, std::string> meshes;    ///< File name of an object's mesh, where one was written.
};

/// The JSON line of one frame (DESIGN, command-line contract): metres, seconds... as the keys say, camera frame, 4x4
/// matrices row-major as four rows. Numbers that are not finite come out as null.
nlohmann::ordered_json scene_json(const Scene& scene, const SceneJsonContext& context = {});

/// The same for one object or grasp of it.
nlohmann::ordered_json object_json(const SceneObject& object, const std::string& mesh_file = "");
nlohmann::ordered_json grasp_json(const Grasp& grasp);

}  // namespace gfp
