#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "core/mesh_read.hpp"
#include "core/text_tokens.hpp"

namespace gfp {
namespace {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

struct PlyType {
  std::size_t bytes = 0;
  char kind = 'i';  ///< i signed, u unsigned, f floating point
};

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  ///< Set for lists.
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
};

std::optional<PlyType> ply_type(std::string_view name) {
  struct Named {
    std::string_view name;
    PlyType type;
  };
  static constexpr std::array<Named, 16> kTypes{{{"char", {1, 'i'}}, {"int8", {1, 'i'}}, {"uchar", {1, 'u'}}, {"uint8", {1, 'u'}},
                                                 {"short", {2, 'i'}}, {"int16", {2, 'i'}}, {"ushort", {2, 'u'}}, {"uint16", {2, 'u'}},
                                                 {"int", {4, 'i'}}, {"int32", {4, 'i'}}, {"uint", {4, 'u'}}, {"uint32", {4, 'u'}},
                                                 {"float", {4, 'f'}}, {"float32", {4, 'f'}}, {"double", {8, 'f'}}, {"float64", {8, 'f'}}}};
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const Named& entry) { return entry.name == name; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

bool parse_property(std::string_view line, PlyElement& element) {
  PlyProperty property;
  auto word = next_token(line);
  if (word == "list") {
    property.count_type = ply_type(next_token(line));
    if (!property.count_type || property.count_type->kind == 'f') return false;
    word = next_token(line);
  }
  const auto type = ply_type(word);
  if (!type) return false;
  property.type = *type;
  property.name = next_token(line);
  element.properties.push_back(property);
  return element.properties.size() <= 256;
}

bool parse_format(std::string_view word, PlyFormat& format) {
  if (word == "ascii") format = PlyFormat::kAscii;
  else if (word == "binary_little_endian") format = PlyFormat::kLittleEndian;
  else if (word == "binary_big_endian") format = PlyFormat::kBigEndian;
  else return false;
  return true;
}

Result<PlyHeader> parse_header(LineCursor& lines, const std::string& name) {
  const auto bad = [&](const char* what) { return tl::unexpected(at_line(name, lines.number(), {ErrorCode::kCorruptData, what})); };
  PlyHeader header;
  std::string_view line;
  if (!lines.next(line) || line != "ply") return bad("expected 'ply'");
  while (lines.next(line)) {
    const auto keyword = next_token(line);
    if (keyword == "end_header") return header;
    if (keyword == "format" && !parse_format(next_token(line), header.format)) return bad("unknown format");
    if (keyword == "element") {
      PlyElement element;
      element.name = next_token(line);
      if (!parse_number(next_token(line), element.count) || header.elements.size() >= 64) return bad("element without a count");
      header.elements.push_back(element);
    }
    if (keyword == "property" && (header.elements.empty() || !parse_property(line, header.elements.back()))) return bad("property that is not understood");
  }
  return bad("header without end_header");
}

/// Gives the values of the body one after the other, whatever the format.
class PlyValues {
 public:
  PlyValues(std::string_view body, PlyFormat format) : rest_(body), format_(format) {}

  bool next(const PlyType& type, double& value) { return format_ == PlyFormat::kAscii ? next_word(value) : next_bytes(type, value); }

 private:
  bool next_word(double& value) {
    const auto begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return false;
    rest_.remove_prefix(begin);
    const auto word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(word.size());
    return parse_number(word, value);
  }

  bool next_bytes(const PlyType& type, double& value) {
    if (rest_.size() < type.bytes) return false;
    std::array<char, 8> bytes{};
    std::copy_n(rest_.data(), type.bytes, bytes.data());
    rest_.remove_prefix(type.bytes);
    if (format_ == PlyFormat::kBigEndian) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    value = decode(bytes, type);
    return true;
  }

  template <class T>
  static double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return static_cast<double>(value);
  }
  static double decode(const std::array<char, 8>& bytes, const PlyType& type) {
    if (type.kind == 'f') return type.bytes == 4 ? as<float>(bytes) : as<double>(bytes);
    if (type.bytes == 1) return type.kind == 'i' ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
    if (type.bytes == 2) return type.kind == 'i' ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
    return type.kind == 'i' ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
  }

  std::string_view rest_;
  PlyFormat format_;
};

/// Reads one row of an element; `scalars` gets a value a property, `list` the named list's.
bool read_row(PlyValues& values, const PlyElement& element, BoundedMesh& mesh, std::vector<double>& scalars, std::vector<std::int64_t>& list) {
  scalars.assign(element.properties.size(), 0.0);
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const auto& property = element.properties[p];
    if (!property.count_type) {
      if (!values.next(property.type, scalars[p])) return false;
      continue;
    }
    double count = 0;
    if (!values.next(*property.count_type, count) || count < 0 || !mesh.corners_allowed(static_cast<std::size_t>(std::min(count, 1e9)))) return false;
    const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
    if (wanted) list.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      double value = 0;
      if (!values.next(property.type, value)) return false;
      if (wanted) list.push_back(std::abs(value) < 1e15 ? static_cast<std::int64_t>(value) : -1);
    }
  }
  return true;
}

std::optional<std::array<std::size_t, 3>> coordinate_columns(const PlyElement& element) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string wanted(1, static_cast<char>('x' + axis));
    const auto found = std::find_if(element.properties.begin(), element.properties.end(), [&](const auto& p) { return p.name == wanted && !p.count_type; });
    if (found == element.properties.end()) return std::nullopt;
    columns[axis] = static_cast<std::size_t>(found - element.properties.begin());
  }
  return columns;
}

}  // namespace

Result<TriangleMesh> read_ply(std::string_view bytes, const std::string& name, const ReadMeshOptions& options) {
  static_assert(std::endian::native == std::endian::little);
  LineCursor lines(bytes);
  const auto header = parse_header(lines, name);
  if (!header) return tl::unexpected(header.error());
  PlyValues values(lines.rest(), header->format);
  BoundedMesh mesh(options);
  std::vector<double> scalars;
  std::vector<std::int64_t> corners;
  for (const auto& element : header->elements) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    const auto columns = coordinate_columns(element);
    if (is_vertex && !columns) return failure(ErrorCode::kCorruptData, name + ": vertices without x, y, z");
    if (element.properties.empty()) continue;
    for (std::size_t row = 0; row < element.count; ++row) {
      corners.clear();
      bool good = read_row(values, element, mesh, scalars, corners);
      if (good && is_vertex) good = mesh.add_vertex({scalars[(*columns)[0]], scalars[(*columns)[1]], scalars[(*columns)[2]]});
      if (good && is_face) good = mesh.add_polygon(corners);
      if (good) continue;
      Error error = mesh.complaint().what.empty() ? Error{ErrorCode::kCorruptData, "ends early or holds no number"} : mesh.complaint();
      error.what = name + ": " + element.name + " " + std::to_string(row) + " of " + std::to_string(element.count) + ": " + error.what;
      return tl::unexpected(error);
    }
  }
  return mesh.take();
}

}  // namespace gfp
