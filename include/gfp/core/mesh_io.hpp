#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

/// Bounds of what read_mesh accepts; checked before anything of that size is allocated.
struct ReadMeshOptions {
  std::size_t max_file_bytes = std::size_t{512} << 20;
  std::size_t max_vertices = 5'000'000;
  std::size_t max_triangles = 10'000'000;
  std::size_t max_polygon_corners = 4096;
};

/// Reads a Wavefront OBJ, PLY (ascii, binary of either byte order), OFF or STL (ascii, binary) file, told apart by its extension.
///
/// Coordinates come as they are in the file (its unit and axes). Polygons are split as fans; colours, normals, texture
/// coordinates and materials are skipped; vertices of an STL, which repeats them, are joined where they are equal.
/// A file without triangles is a result. Degenerate or inconsistent triangles are kept: examine_topology judges them.
/// Errors: kNotFound, kIo, kUnsupported (extension), kTooLarge (file, vertices, triangles, corners), kCorruptData (naming the line
/// or element: a number that does not parse or is not finite, an index out of range, fewer bytes than announced).
Result<TriangleMesh> read_mesh(const std::filesystem::path& path, const ReadMeshOptions& options = {});

/// Writes a binary little-endian PLY (float positions, uchar colours) for people's viewers.
/// @param colours one a vertex, or empty.  Errors: kInvalidArgument (count of colours), kIo.
Result<void> write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours = {});

/// Writes an OBJ with nine significant digits; colours follow the coordinates as in MeshLab. Errors: as write_ply.
Result<void> write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours = {});

/// Writes a binary glTF 2.0 with smooth normals. glTF is y-up: (x, y, z) becomes (x, z, -y). Errors: as write_ply.
Result<void> write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours = {});

/// The bytes write_glb writes, for those who send them.
std::vector<std::byte> encode_glb(const TriangleMesh& mesh, const std::vector<Rgb8>& colours = {});

}  // namespace gfp
