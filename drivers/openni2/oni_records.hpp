#pragma once

#include <filesystem>

namespace gfp {

/// Whether an .oni file holds a frame, finished or not: OpenNI2's recorder does not say when it has begun. False where it is no such file.
/// Its records: a header of 28 bytes, little-endian (magic, type, node, bytes of header and fields, bytes of payload, place of the one before), from byte 24 on.
bool oni_file_has_frames(const std::filesystem::path& file);

}  // namespace gfp
