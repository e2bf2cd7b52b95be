#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp::wire {

inline constexpr std::size_t kMaxPrimitiveBytes = std::size_t{64} << 20;
inline constexpr std::uint32_t kMaxPrimitiveVertices = 65'536;
inline constexpr int kMaxModes = 64;

/// The bytes of a .gfp file (proto/gfp/v1/primitive.proto). Decoding them gives an equal primitive, bit by bit.
std::string encode_primitive(const Primitive& primitive);

/// Errors: kTooLarge (bytes, vertices, modes, lists), kUnsupported (schema version), kCorruptData (anything that does not parse or
/// fit: lengths, indices, numbers that are not finite, a surface that is not closed or not of its genus, a covariance that is not
/// positive definite, hashes that are not the content's).
Result<Primitive> decode_primitive(std::span<const std::byte> bytes);

/// Several primitives as one PrimitiveSet. Errors: as decode_primitive, for the first bad one.
std::string encode_primitives(const std::vector<Primitive>& primitives);
Result<std::vector<Primitive>> decode_primitives(std::span<const std::byte> bytes);

/// Errors: kNotFound, kIo, and as decode_primitive with the file's name in front.
Result<Primitive> read_primitive(const std::filesystem::path& file);
/// The file appears whole or not at all: it is written beside its place and renamed. Errors: kIo.
Result<void> write_primitive(const std::filesystem::path& file, const Primitive& primitive);

/// All *.gfp files of a folder, by file name. Errors: kNotFound, and as read_primitive for the first bad one.
Result<std::vector<Primitive>> read_primitive_folder(const std::filesystem::path& folder);

}  // namespace gfp::wire
