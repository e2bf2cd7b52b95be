#include "mesh_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>

#include "gfp/core/mesh_io.hpp"
#include "gfp/evaluation/voxel_solid.hpp"
#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

constexpr std::uintmax_t kMaxTableBytes = 16U << 20U;
constexpr std::size_t kMostComponents = 2000;  // of which every two are compared
constexpr double kWeld_m = 1e-5;
constexpr double kMaxSize_m = 2.0;  // larger things do not stand on a table

// Fields of one line; quotes may hold commas, and a doubled quote is a quote.
std::vector<std::string> split_line(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') fields.back() += line[++i];
    else if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) fields.emplace_back();
    else if (c != '\r') fields.back() += c;
  }
  return fields;
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

tl::unexpected<Error> corrupt(const std::filesystem::path& file, std::size_t line, const std::string& what) {
  return failure(ErrorCode::kCorruptData, file.string() + ":" + std::to_string(line) + ": " + what);
}

constexpr std::array kColumns{"file", "class", "scale_to_m", "up_axis"};

Result<MeshEntry> parse_entry(const std::vector<std::string>& fields, const std::array<std::size_t, 4>& column,
                              const std::filesystem::path& file, std::size_t line) {
  if (fields.size() <= *std::max_element(column.begin(), column.end())) return corrupt(file, line, std::to_string(fields.size()) + " fields, expected one for each column");
  MeshEntry entry{fields[column[0]], fields[column[1]], 0, 'z'};
  const std::string &scale = fields[column[2]], &axis = fields[column[3]];
  const auto parsed = std::from_chars(scale.data(), scale.data() + scale.size(), entry.scale_to_m);
  if (parsed.ec != std::errc{} || parsed.ptr != scale.data() + scale.size() || !(entry.scale_to_m > 0) || !std::isfinite(entry.scale_to_m))
    return corrupt(file, line, "scale_to_m = " + scale + ", expected a positive number");
  if (axis != "x" && axis != "y" && axis != "z") return corrupt(file, line, "up_axis = " + axis + ", expected x, y or z");
  entry.up_axis = axis[0];
  return entry;
}

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    auto& up = parent[static_cast<std::size_t>(i)];
    i = up = parent[static_cast<std::size_t>(up)];
  }
  return i;
}

// Vertices as an OBJ repeats them (one a texture seam) become one.
std::vector<std::int32_t> welded_indices(const std::vector<Eigen::Vector3d>& vertices) {
  std::map<std::array<long long, 3>, std::int32_t> first;
  std::vector<std::int32_t> index;
  for (const auto& v : vertices) {
    const std::array<long long, 3> cell{std::llround(v.x() / kWeld_m), std::llround(v.y() / kWeld_m), std::llround(v.z() / kWeld_m)};
    index.push_back(first.try_emplace(cell, static_cast<std::int32_t>(index.size())).first->second);
  }
  return index;
}

}  // namespace

Result<std::vector<MeshEntry>> read_mesh_table(const std::filesystem::path& file) {
  const auto text = read_file(file, kMaxTableBytes);
  if (!text) return tl::unexpected(text.error());
  const auto lines = split_lines(*text);
  if (lines.empty()) return corrupt(file, 1, "empty, expected a header");
  const auto header = split_line(lines.front());
  std::array<std::size_t, 4> column{};
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const auto found = std::find(header.begin(), header.end(), kColumns[c]);
    if (found == header.end()) return corrupt(file, 1, "no column `" + std::string(kColumns[c]) + "`");
    column[c] = static_cast<std::size_t>(found - header.begin());
  }
  std::vector<MeshEntry> entries;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i] == "\r") continue;
    auto entry = parse_entry(split_line(lines[i]), column, file, i + 1);
    if (!entry) return tl::unexpected(entry.error());
    entries.push_back(std::move(*entry));
  }
  return entries;
}

TriangleMesh upright(TriangleMesh mesh, char up_axis) {
  for (auto& v : mesh.vertices) {
    if (up_axis == 'y') v = Eigen::Vector3d(v.x(), -v.z(), v.y());
    if (up_axis == 'x') v = Eigen::Vector3d(-v.z(), v.y(), v.x());
  }
  return mesh;
}

TriangleMesh on_origin(TriangleMesh mesh) {
  const Bounds box = bounds(mesh.vertices);
  const Eigen::Vector3d base(box.centre().x(), box.centre().y(), box.low.z());
  for (auto& v : mesh.vertices) v -= base;
  return mesh;
}

TriangleMesh stood_up(const TriangleMesh& mesh, bool& turned) {
  constexpr double kVoxel_m = 0.002, kClearlyMore = 1.5;
  constexpr double kQuarter = 1.5707963267948966;
  const auto filled = [](const TriangleMesh& m) {
    const auto solid = fill_solid(m, kVoxel_m, true);
    return solid ? solid->filled.volume_m3() : 0.0;
  };
  TriangleMesh best = mesh;
  double most = kClearlyMore * filled(mesh);
  turned = false;
  for (const Eigen::Vector3d& turn : {Eigen::Vector3d(kQuarter, 0, 0), Eigen::Vector3d(-kQuarter, 0, 0), Eigen::Vector3d(0, kQuarter, 0),
                                      Eigen::Vector3d(0, -kQuarter, 0), Eigen::Vector3d(2 * kQuarter, 0, 0)}) {
    Transform T = Transform::Identity();
    T.linear() = rotation_from_vector(turn);
    TriangleMesh other = transformed(mesh, T);
    const double volume = filled(other);
    if (volume <= most) continue;
    most = volume;
    best = std::move(other);
    turned = true;
  }
  return best;
}

std::vector<TriangleMesh> split_groups(const TriangleMesh& mesh) {
  const auto index = welded_indices(mesh.vertices);
  std::vector<std::int32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&](std::int32_t a, std::int32_t b) {
    const std::int32_t ra = root_of(parent, a), rb = root_of(parent, b);
    parent[static_cast<std::size_t>(std::max(ra, rb))] = std::min(ra, rb);
  };
  const auto vertex = [&](std::int32_t corner) { return index[static_cast<std::size_t>(corner)]; };
  for (const Triangle& t : mesh.triangles) {
    join(vertex(t[0]), vertex(t[1]));
    join(vertex(t[1]), vertex(t[2]));
  }
  std::map<std::int32_t, Bounds> boxes;  // per component
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t corner : t) boxes[root_of(parent, vertex(corner))].include(mesh.vertices[static_cast<std::size_t>(corner)]);
  const bool soup = boxes.size() > kMostComponents;  // one thing, whatever its parts touch
  for (auto a = boxes.begin(); a != boxes.end(); ++a)
    for (auto b = soup ? boxes.begin() : a; b != boxes.end() && (!soup || b == boxes.begin()); ++b)
      if (soup || ((a->second.low.array() <= b->second.high.array()).all() && (b->second.low.array() <= a->second.high.array()).all())) join(a->first, b->first);

  std::map<std::int32_t, TriangleMesh> groups;
  std::vector<std::int32_t> place(mesh.vertices.size(), -1);  // of a welded vertex in its group's mesh
  for (const Triangle& t : mesh.triangles) {
    TriangleMesh& group = groups[root_of(parent, vertex(t[0]))];
    Triangle moved{};
    for (std::size_t k = 0; k < 3; ++k) {
      auto& there = place[static_cast<std::size_t>(vertex(t[k]))];
      if (there < 0) {
        there = static_cast<std::int32_t>(group.vertices.size());
        group.vertices.push_back(mesh.vertices[static_cast<std::size_t>(vertex(t[k]))]);
      }
      moved[k] = there;
    }
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) group.triangles.push_back(moved);
  }
  std::vector<TriangleMesh> result;
  for (auto& [root, group] : groups) result.push_back(std::move(group));
  return result;
}

Result<std::vector<TriangleMesh>> load_objects(const std::filesystem::path& folder, const MeshEntry& entry) {
  auto mesh = read_mesh(folder / entry.file);
  if (!mesh) return tl::unexpected(mesh.error());
  if (mesh->triangles.empty()) return failure(ErrorCode::kCorruptData, (folder / entry.file).string() + ": no triangles");
  for (auto& v : mesh->vertices) v *= entry.scale_to_m;
  const double largest = bounds(mesh->vertices).size().maxCoeff();
  if (!(largest <= kMaxSize_m)) return failure(ErrorCode::kTooLarge, (folder / entry.file).string() + ": spans " + std::to_string(largest) + " m, expected at most " + std::to_string(kMaxSize_m) + " (scale_to_m?)");
  std::vector<TriangleMesh> groups = split_groups(upright(std::move(*mesh), entry.up_axis));
  const bool several = std::filesystem::path(entry.file).stem().string().ends_with("_pair");
  TriangleMesh whole;
  for (TriangleMesh& group : groups) {
    if (several) group = on_origin(std::move(group));
    else append(whole, group);
  }
  if (several) return groups;
  return std::vector<TriangleMesh>{on_origin(std::move(whole))};
}

}  // namespace gfp
