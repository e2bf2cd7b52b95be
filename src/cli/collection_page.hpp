#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "gfp/collection/build_primitive.hpp"

namespace gfp {

/// Draws what a class came to into FOLDER/<class>/: the sheet of mean, control points and modes, the symmetry, and every member.
/// `primitive` is null where the class was refused. Errors: kIo.
Result<void> draw_class(const std::filesystem::path& folder, const std::string& name, const Primitive* primitive, const std::vector<MemberReport>& members);

/// The page FOLDER/index.html over the classes' records (primitive_build.cpp) and their pictures. Errors: kIo.
Result<void> write_collection_page(const std::filesystem::path& folder, const nlohmann::json& classes);

}  // namespace gfp
