#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// A line for the frame and one for each object, for people.
void print_table(std::ostream& out, const std::string& input, const Scene& scene);

/// `<stem>_<frame>_<id>`: what the files made of one object are called.
std::string object_stem(const std::string& stem, const Scene& scene, const SceneObject& object);

/// Writes every object as .ply, .obj and .glb, camera frame; observed vertices have the object's colour, inferred ones are pale.
/// Returns the .ply's file name by object id. Errors: kIo.
Result<std::map<std::uint64_t, std::string>> write_meshes(const std::filesystem::path& folder, const std::string& stem, const Scene& scene);

/// `file` with `_<number>` before its extension, four digits.
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number);

}  // namespace gfp
