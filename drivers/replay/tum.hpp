#pragma once

#include <filesystem>
#include <vector>

#include "replay/listing.hpp"

namespace gfp {

/// Has the form of a recording of the TUM RGB-D benchmark: associations.txt, depth.txt or a folder depth/.
bool is_tum_folder(const std::filesystem::path& folder);

/// Its frames by time, 5000 depth units a metre. From associations.txt; else depth.txt with the nearest colour image of rgb.txt
/// within 20 ms; else depth/*.png with the same name or time in rgb/. Lists may name only files inside the folder.
/// Errors: kCorruptData (a malformed line), kInvalidArgument (a path that leaves the folder), kUnsupported (no frames), kIo, kTooLarge.
Result<std::vector<ReplayEntry>> list_tum_folder(const std::filesystem::path& folder);

}  // namespace gfp
