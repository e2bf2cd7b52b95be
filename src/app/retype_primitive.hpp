#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// The primitive of this name in a user's folder, else the built-in one. Errors: kNotFound, and those of reading its file.
Result<Primitive> primitive_to_retype(const std::filesystem::path& folder, const std::string& name);

/// Says by hand what the chosen vertices are (a flag each): empty: what they are by themselves. Returns how many changed.
int set_types_by_hand(const std::vector<bool>& chosen, std::optional<PointType> type, Primitive& primitive);

/// Puts it into the folder, which is made where it is not there. The first of its class in the folder brings the built-in ones of that class
/// along, since what a folder has of a class replaces all of it. Returns its file. Errors: kIo.
Result<std::filesystem::path> keep_primitive(const std::filesystem::path& folder, const Primitive& primitive);

}  // namespace gfp
