#include "core/mesh_read.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>

#include "core/text_tokens.hpp"

namespace gfp {
namespace {

Result<std::string> read_whole_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code status;
  const auto bytes = std::filesystem::file_size(path, status);
  if (status) return failure(ErrorCode::kNotFound, path.string() + ": " + status.message());
  if (bytes > max_bytes)
    return failure(ErrorCode::kTooLarge, path.string() + ": " + std::to_string(bytes) + " bytes, at most " + std::to_string(max_bytes));
  std::ifstream file(path, std::ios::binary);
  std::string content(bytes, '\0');
  if (!file.read(content.data(), static_cast<std::streamsize>(bytes))) return failure(ErrorCode::kIo, path.string() + ": cannot be read");
  return content;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool parse_point(std::string_view& line, Eigen::Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis)
    if (!parse_number(next_token(line), point[axis])) return false;
  return true;
}

tl::unexpected<Error> corrupt(const std::string& name, std::size_t line, std::string what) {
  return tl::unexpected<Error>(at_line(name, line, {ErrorCode::kCorruptData, std::move(what)}));
}

/// "7", "7/1", "7//3", "-1/..." -> index from 0; negative ones count from the end.
bool parse_obj_corner(std::string_view token, std::size_t vertices, std::int64_t& corner) {
  if (!parse_number(token.substr(0, token.find('/')), corner) || corner == 0) return false;
  corner = corner > 0 ? corner - 1 : static_cast<std::int64_t>(vertices) + corner;
  return true;
}

/// Corners of triangles that repeat a position become one vertex; order of first appearance.
TriangleMesh join_equal_vertices(const std::vector<Eigen::Vector3d>& corners) {
  const auto less = [&](std::int32_t a, std::int32_t b) {
    const auto& p = corners[static_cast<std::size_t>(a)];
    const auto& q = corners[static_cast<std::size_t>(b)];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::vector<std::int32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<std::int32_t> first(corners.size());  // the first corner at the same place
  for (std::size_t i = 0; i < order.size(); ++i)
    first[static_cast<std::size_t>(order[i])] =
        i > 0 && !less(order[i - 1], order[i]) ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  TriangleMesh mesh;
  std::vector<std::int32_t> vertex(corners.size(), -1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto& own = vertex[static_cast<std::size_t>(first[i])];
    if (own < 0) {
      own = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.push_back(corners[i]);
    }
    if (i % 3 == 0) mesh.triangles.push_back({});
    mesh.triangles.back()[i % 3] = own;
  }
  return mesh;
}

Result<TriangleMesh> read_binary_stl(std::string_view bytes, std::size_t triangles, const std::string& name) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(3 * triangles);
  for (std::size_t triangle = 0; triangle < triangles; ++triangle) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float xyz[3];
      std::copy_n(bytes.data() + 84 + 50 * triangle + 12 + 12 * corner, sizeof(xyz), reinterpret_cast<char*>(xyz));
      corners.emplace_back(xyz[0], xyz[1], xyz[2]);
      if (!corners.back().allFinite()) return failure(ErrorCode::kCorruptData, name + ": triangle " + std::to_string(triangle) + " is not finite");
    }
  }
  return join_equal_vertices(corners);
}

}  // namespace

Error at_line(const std::string& name, std::size_t line, const Error& error) {
  return {error.code, name + ", line " + std::to_string(line) + ": " + error.what};
}

bool BoundedMesh::complain(ErrorCode code, std::string what) {
  if (complaint_.what.empty()) complaint_ = {code, std::move(what)};
  return false;
}

bool BoundedMesh::add_vertex(const Eigen::Vector3d& point) {
  if (!point.allFinite()) return complain(ErrorCode::kCorruptData, "coordinate is not finite");
  if (mesh_.vertices.size() >= options_.max_vertices)
    return complain(ErrorCode::kTooLarge, "more than " + std::to_string(options_.max_vertices) + " vertices");
  mesh_.vertices.push_back(point);
  return true;
}

bool BoundedMesh::corners_allowed(std::size_t corners) {
  if (corners <= options_.max_polygon_corners) return true;
  return complain(ErrorCode::kTooLarge, "polygon of " + std::to_string(corners) + " corners, at most " + std::to_string(options_.max_polygon_corners));
}

bool BoundedMesh::add_polygon(const std::vector<std::int64_t>& corners) {
  if (corners.size() < 3) return complain(ErrorCode::kCorruptData, "polygon of " + std::to_string(corners.size()) + " corners, expected 3 or more");
  if (!corners_allowed(corners.size())) return false;
  for (const auto corner : corners)
    if (corner < 0 || corner >= static_cast<std::int64_t>(mesh_.vertices.size()))
      return complain(ErrorCode::kCorruptData, "vertex index " + std::to_string(corner) + " (from 0), expected [0, " + std::to_string(mesh_.vertices.size()) + ")");
  if (mesh_.triangles.size() + corners.size() - 2 > options_.max_triangles)
    return complain(ErrorCode::kTooLarge, "more than " + std::to_string(options_.max_triangles) + " triangles");
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh_.triangles.push_back({static_cast<std::int32_t>(corners[0]), static_cast<std::int32_t>(corners[i - 1]), static_cast<std::int32_t>(corners[i])});
  return true;
}

Result<TriangleMesh> read_obj(std::string_view text, const std::string& name, const ReadMeshOptions& options) {
  BoundedMesh mesh(options);
  LineCursor lines(text);
  std::vector<std::int64_t> corners;
  for (std::string_view line; lines.next_meaningful(line);) {
    const auto keyword = next_token(line);
    if (keyword == "v") {
      Eigen::Vector3d point;
      if (!parse_point(line, point)) return corrupt(name, lines.number(), "vertex without three finite numbers");
      if (!mesh.add_vertex(point)) return tl::unexpected(at_line(name, lines.number(), mesh.complaint()));
    } else if (keyword == "f") {
      corners.clear();
      for (auto token = next_token(line); !token.empty(); token = next_token(line)) {
        std::int64_t corner = 0;
        if (!parse_obj_corner(token, mesh.vertices(), corner)) return corrupt(name, lines.number(), "face corner '" + std::string(token.substr(0, 40)) + "'");
        corners.push_back(corner);
      }
      if (!mesh.add_polygon(corners)) return tl::unexpected(at_line(name, lines.number(), mesh.complaint()));
    }
  }
  return mesh.take();
}

Result<TriangleMesh> read_off(std::string_view text, const std::string& name, const ReadMeshOptions& options) {
  LineCursor lines(text);
  std::string_view line;
  if (!lines.next_meaningful(line)) return failure(ErrorCode::kCorruptData, name + ": empty file");
  const auto magic = next_token(line);
  if (magic != "OFF" && magic != "COFF" && magic != "NOFF") return corrupt(name, lines.number(), "expected OFF, COFF or NOFF");
  auto token = next_token(line);  // some files give the counts behind the magic word
  if (token.empty() && lines.next_meaningful(line)) token = next_token(line);
  std::size_t vertices = 0, faces = 0;
  if (!parse_number(token, vertices) || !parse_number(next_token(line), faces)) return corrupt(name, lines.number(), "expected the counts of vertices and faces");

  BoundedMesh mesh(options);
  for (std::size_t i = 0; i < vertices; ++i) {
    Eigen::Vector3d point;
    if (!lines.next_meaningful(line) || !parse_point(line, point)) return corrupt(name, lines.number(), "vertex " + std::to_string(i) + " of " + std::to_string(vertices) + " without three finite numbers");
    if (!mesh.add_vertex(point)) return tl::unexpected(at_line(name, lines.number(), mesh.complaint()));
  }
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < faces; ++i) {
    std::size_t count = 0;
    if (!lines.next_meaningful(line) || !parse_number(next_token(line), count)) return corrupt(name, lines.number(), "face " + std::to_string(i) + " of " + std::to_string(faces) + " is missing");
    if (!mesh.corners_allowed(count)) return tl::unexpected(at_line(name, lines.number(), mesh.complaint()));
    corners.assign(count, 0);
    for (auto& corner : corners)
      if (!parse_number(next_token(line), corner)) return corrupt(name, lines.number(), "face " + std::to_string(i) + " lacks an index");
    if (!mesh.add_polygon(corners)) return tl::unexpected(at_line(name, lines.number(), mesh.complaint()));
  }
  return mesh.take();
}

Result<TriangleMesh> read_stl(std::string_view bytes, const std::string& name, const ReadMeshOptions& options) {
  const auto too_many = [&](std::size_t triangles) {
    return failure(ErrorCode::kTooLarge, name + ": " + std::to_string(triangles) + " triangles, at most " + std::to_string(options.max_triangles));
  };
  if (bytes.size() >= 84) {  // ascii files also begin with "solid", so that the announced size decides
    std::uint32_t triangles = 0;
    std::copy_n(bytes.data() + 80, sizeof(triangles), reinterpret_cast<char*>(&triangles));
    if (bytes.size() == 84 + std::size_t{50} * triangles) return triangles > options.max_triangles ? too_many(triangles) : read_binary_stl(bytes, triangles, name);
  }
  if (!bytes.starts_with("solid")) return failure(ErrorCode::kCorruptData, name + ": neither a binary STL of the announced length nor an ascii one");
  std::vector<Eigen::Vector3d> corners;
  LineCursor lines(bytes);
  for (std::string_view line; lines.next(line);) {
    if (next_token(line) != "vertex") continue;
    Eigen::Vector3d point;
    if (!parse_point(line, point)) return corrupt(name, lines.number(), "vertex without three finite numbers");
    corners.push_back(point);
    if (corners.size() > 3 * options.max_triangles) return too_many(corners.size() / 3);
  }
  if (corners.size() % 3 != 0) return failure(ErrorCode::kCorruptData, name + ": " + std::to_string(corners.size()) + " corners are no whole triangles");
  return join_equal_vertices(corners);
}

Result<TriangleMesh> read_mesh(const std::filesystem::path& path, const ReadMeshOptions& options) {
  using Reader = Result<TriangleMesh> (*)(std::string_view, const std::string&, const ReadMeshOptions&);
  const std::string extension = lower_extension(path);
  const Reader reader = extension == ".obj" ? read_obj : extension == ".off" ? read_off : extension == ".stl" ? read_stl : extension == ".ply" ? read_ply : nullptr;
  if (reader == nullptr) return failure(ErrorCode::kUnsupported, path.string() + ": extension '" + extension + "', expected .obj, .ply, .off or .stl");
  auto content = read_whole_file(path, options.max_file_bytes);
  if (!content) return tl::unexpected(content.error());
  return reader(*content, path.string(), options);
}

}  // namespace gfp
