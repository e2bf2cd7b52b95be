#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#include "gfp/core/mesh_io.hpp"

namespace gfp {
namespace {

void put_bytes(std::string& out, const void* value, std::size_t bytes) { out.append(static_cast<const char*>(value), bytes); }

template <class T>
void put(std::string& out, T value) {
  put_bytes(out, &value, sizeof(T));
}

void put_point(std::string& out, const Eigen::Vector3d& p) {
  for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(p[axis]));
}

Result<void> check_colours(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  if (colours.empty() || colours.size() == mesh.vertices.size()) return {};
  return failure(ErrorCode::kInvalidArgument, "colours.size() = " + std::to_string(colours.size()) + ", expected 0 or " + std::to_string(mesh.vertices.size()));
}

Result<void> write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return failure(ErrorCode::kIo, path.string() + ": cannot be written");
  return {};
}

std::string encode_ply(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!colours.empty()) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  out += "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    put_point(out, mesh.vertices[i]);
    if (!colours.empty()) put_bytes(out, &colours[i], 3);
  }
  for (const auto& triangle : mesh.triangles) {
    put(out, std::uint8_t{3});
    put_bytes(out, triangle.data(), sizeof(triangle));
  }
  return out;
}

std::string encode_obj(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  std::string out;
  char line[200];
  const auto put_line = [&](int length) { out.append(line, static_cast<std::size_t>(length)); };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto& p = mesh.vertices[i];
    put_line(std::snprintf(line, sizeof(line), "v %.9g %.9g %.9g", p.x(), p.y(), p.z()));
    if (!colours.empty()) put_line(std::snprintf(line, sizeof(line), " %.4f %.4f %.4f", colours[i].r / 255.0, colours[i].g / 255.0, colours[i].b / 255.0));
    out += '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) put_line(std::snprintf(line, sizeof(line), "f %d %d %d\n", a + 1, b + 1, c + 1));
  return out;
}

Eigen::Vector3d y_up(const Eigen::Vector3d& p) { return {p.x(), p.z(), -p.y()}; }

void pad(std::string& bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes += filler;
}

/// The binary chunk and where its parts begin: indices, positions, normals, colours (RGBA, as alignment wants).
struct GlbBuffer {
  std::string bytes;
  std::size_t positions = 0, normals = 0, colours = 0;
  Eigen::Vector3f low, high;
};

GlbBuffer fill_buffer(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  GlbBuffer buffer;
  for (const auto& triangle : mesh.triangles) put_bytes(buffer.bytes, triangle.data(), sizeof(triangle));
  buffer.positions = buffer.bytes.size();
  Bounds box;
  for (const auto& p : mesh.vertices) {
    put_point(buffer.bytes, y_up(p));
    box.include(y_up(p));
  }
  buffer.low = box.low.cast<float>();
  buffer.high = box.high.cast<float>();
  buffer.normals = buffer.bytes.size();
  for (const auto& normal : vertex_normals(mesh)) put_point(buffer.bytes, normal.squaredNorm() > 0 ? y_up(normal) : Eigen::Vector3d::UnitY());
  buffer.colours = buffer.bytes.size();
  for (const auto& colour : colours) put(buffer.bytes, std::array<std::uint8_t, 4>{colour.r, colour.g, colour.b, 255});
  return buffer;
}

std::string vector_json(const Eigen::Vector3f& v) {
  char text[100];
  std::snprintf(text, sizeof(text), "[%.9g,%.9g,%.9g]", static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z()));
  return text;
}

std::string view_json(std::size_t offset, std::size_t length, int target) {
  return "{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) + ",\"byteLength\":" + std::to_string(length) + ",\"target\":" + std::to_string(target) + "}";
}

std::string accessor_json(int view, int component, std::size_t count, const std::string& type, const std::string& more = {}) {
  return "{\"bufferView\":" + std::to_string(view) + ",\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) + ",\"type\":\"" + type + "\"" + more + "}";
}

std::string gltf_json(const TriangleMesh& mesh, const GlbBuffer& buffer) {
  constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963, kFloat = 5126, kUnsignedInt = 5125, kUnsignedByte = 5121;
  const std::size_t n = mesh.vertices.size();
  const bool coloured = buffer.colours < buffer.bytes.size();
  std::string json = R"({"asset":{"version":"2.0","generator":"gfp"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)";
  json += R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.8}}],)";
  json += R"("meshes":[{"primitives":[{"attributes":{"POSITION":1,"NORMAL":2)" + std::string(coloured ? R"(,"COLOR_0":3)" : "") + R"(},"indices":0,"material":0}]}],)";
  json += "\"buffers\":[{\"byteLength\":" + std::to_string(buffer.bytes.size()) + "}],\"bufferViews\":[" +
          view_json(0, buffer.positions, kElementArrayBuffer) + ',' + view_json(buffer.positions, 12 * n, kArrayBuffer) + ',' + view_json(buffer.normals, 12 * n, kArrayBuffer);
  if (coloured) json += ',' + view_json(buffer.colours, 4 * n, kArrayBuffer);
  json += "],\"accessors\":[" + accessor_json(0, kUnsignedInt, 3 * mesh.triangles.size(), "SCALAR") + ',' +
          accessor_json(1, kFloat, n, "VEC3", ",\"min\":" + vector_json(buffer.low) + ",\"max\":" + vector_json(buffer.high)) + ',' + accessor_json(2, kFloat, n, "VEC3");
  if (coloured) json += ',' + accessor_json(3, kUnsignedByte, n, "VEC4", ",\"normalized\":true");
  return json + "]}";
}

std::string encode_glb_string(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  // glTF forbids empty buffers and accessors: a mesh without triangles is an empty scene.
  if (mesh.triangles.empty()) {
    std::string json = R"({"asset":{"version":"2.0","generator":"gfp"}})";
    pad(json, ' ');
    std::string out = "glTF";
    for (const auto word : {2U, static_cast<unsigned>(20 + json.size()), static_cast<unsigned>(json.size())}) put(out, word);
    return out + "JSON" + json;
  }
  GlbBuffer buffer = fill_buffer(mesh, colours);
  std::string json = gltf_json(mesh, buffer);
  pad(json, ' ');
  std::string out = "glTF";
  for (const auto word : {2U, static_cast<unsigned>(28 + json.size() + buffer.bytes.size()), static_cast<unsigned>(json.size())}) put(out, word);
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(buffer.bytes.size()));
  put_bytes(out, "BIN\0", 4);
  return out + buffer.bytes;
}

using Encoder = std::string (*)(const TriangleMesh&, const std::vector<Rgb8>&);

Result<void> write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours, Encoder encode) {
  if (auto checked = check_colours(mesh, colours); !checked) return checked;
  return write_file(path, encode(mesh, colours));
}

}  // namespace

Result<void> write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  return write_mesh(path, mesh, colours, encode_ply);
}

Result<void> write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  return write_mesh(path, mesh, colours, encode_obj);
}

Result<void> write_glb(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  return write_mesh(path, mesh, colours, encode_glb_string);
}

std::vector<std::byte> encode_glb(const TriangleMesh& mesh, const std::vector<Rgb8>& colours) {
  const std::string bytes = encode_glb_string(mesh, colours);
  std::vector<std::byte> out(bytes.size());
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace gfp
