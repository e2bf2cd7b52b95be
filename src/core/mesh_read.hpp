#pragma once

#include <string>
#include <string_view>

#include "gfp/core/mesh_io.hpp"

namespace gfp {

/// One reader a format, all on the file's bytes; `name` is what errors call the file.
Result<TriangleMesh> read_obj(std::string_view text, const std::string& name, const ReadMeshOptions& options);
Result<TriangleMesh> read_off(std::string_view text, const std::string& name, const ReadMeshOptions& options);
Result<TriangleMesh> read_stl(std::string_view bytes, const std::string& name, const ReadMeshOptions& options);
Result<TriangleMesh> read_ply(std::string_view bytes, const std::string& name, const ReadMeshOptions& options);

/// Collects a mesh under the bounds of the options. The first complaint is kept; later calls do nothing.
class BoundedMesh {
 public:
  explicit BoundedMesh(const ReadMeshOptions& options) : options_(options) {}

  bool add_vertex(const Eigen::Vector3d& point);
  bool add_polygon(const std::vector<std::int64_t>& corners);  ///< From 0; split as a fan.
  bool corners_allowed(std::size_t corners);
  const Error& complaint() const { return complaint_; }
  std::size_t vertices() const { return mesh_.vertices.size(); }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  bool complain(ErrorCode code, std::string what);

  ReadMeshOptions options_;
  TriangleMesh mesh_;
  Error complaint_{};
};

/// "FILE, line N: what".
Error at_line(const std::string& name, std::size_t line, const Error& error);

}  // namespace gfp
