#include "config/field_loader.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gfp::config {
namespace {

/// Levenshtein distance, for "did you mean".
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

bool is_rigid(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  return matrix.allFinite() && (rotation * rotation.transpose()).isIdentity(1e-3) && rotation.determinant() > 0 &&
         matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-9);
}

}  // namespace

void Problems::add(int line, std::string_view path, std::string_view what) {
  if (++count_ > kListed) return;
  if (!text_.empty()) text_ += '\n';
  text_ += is_file_ ? fmt::format("{}:{}: {} {}", source_, line + 1, path, what) : fmt::format("{}: {} {}", source_, path, what);
}

Error Problems::error() const {
  if (count_ <= kListed) return {ErrorCode::kInvalidArgument, text_};
  return {ErrorCode::kInvalidArgument, fmt::format("{}\n{}: and {} more", text_, source_, count_ - kListed)};
}

FieldLoader::FieldLoader(YAML::Node map, std::string path, Problems& problems)
    : map_(std::move(map)), path_(std::move(path)), problems_(problems) {}

void FieldLoader::problem(const YAML::Node& node, std::string_view path, std::string_view what) const {
  problems_.add(node.IsNull() ? key_line_ : node.Mark().line, path, what);
}

YAML::Node FieldLoader::take(std::string_view name) {
  known_.emplace_back(name);
  for (const auto& entry : map_)  // not operator[]: it would convert every key
    if (entry.first.IsScalar() && entry.first.Scalar() == name) {
      key_line_ = entry.first.Mark().line;
      return entry.second;
    }
  return YAML::Node(YAML::NodeType::Undefined);
}

std::string FieldLoader::path_of(std::string_view name) const { return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name); }

std::string FieldLoader::plain_scalar(const YAML::Node& node) {
  return node.IsScalar() && node.Tag() != "!" ? node.Scalar() : std::string();  // yaml-cpp tags quoted text with "!"
}

std::string FieldLoader::shown(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "nothing";
  std::string text = node.Scalar().substr(0, 60);
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return node.Tag() == "!" ? fmt::format("\"{}\"", text) : text;
}

bool FieldLoader::text_of(const YAML::Node& node, const std::string& path, std::string& value) const {
  const bool fits = node.IsScalar() && node.Scalar().size() <= kMaxTextBytes;
  if (fits) value = node.Scalar();
  else problem(node, path, fmt::format("= {}, expected text of at most {} bytes", shown(node), kMaxTextBytes));
  return fits;
}

bool FieldLoader::short_list(const YAML::Node& node, const std::string& path) const {
  const bool fits = (node.IsSequence() && node.size() <= kMaxListItems) || node.IsNull();
  if (!fits) problem(node, path, fmt::format("= {}, expected a list of at most {}", shown(node), kMaxListItems));
  return fits;
}

bool FieldLoader::list_or_indices(const YAML::Node& node, const std::string& path, std::size_t size) const {
  if (!node.IsMap()) return short_list(node, path);
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    std::size_t index = 0;
    const auto [end, status] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (status == std::errc() && end == key.data() + key.size() && index < size) continue;
    problem(node, fmt::format("{}.{}", path, key), fmt::format("is not one of the {} elements of the list, counted from 0", size));
    return false;
  }
  return true;
}

void FieldLoader::operator()(std::string_view name, bool& value) {
  const YAML::Node node = take(name);
  if (!node) return;
  const std::string text = plain_scalar(node);
  if (text == "true" || text == "false") value = text == "true";
  else problem(node, path_of(name), fmt::format("= {}, expected true or false", shown(node)));
}

void FieldLoader::operator()(std::string_view name, std::string& value) {
  if (const YAML::Node node = take(name)) text_of(node, path_of(name), value);
}

void FieldLoader::operator()(std::string_view name, std::string& value, const OneOf& choice) {
  const YAML::Node node = take(name);
  if (!node) return;
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const auto& values = choice.values;
  if (std::find(values.begin(), values.end(), text) != values.end()) value = text;
  else problem(node, path_of(name), fmt::format("= {}, expected one of {}", shown(node), fmt::join(values, ", ")));
}

void FieldLoader::operator()(std::string_view name, std::vector<std::string>& values) {
  const YAML::Node node = take(name);
  if (!node || !short_list(node, path_of(name))) return;
  values.clear();
  for (std::size_t i = 0; i < node.size(); ++i) {
    std::string text;
    if (text_of(node[i], fmt::format("{}.{}", path_of(name), i), text)) values.push_back(text);
  }
}

void FieldLoader::operator()(std::string_view name, std::vector<double>& values, double low, double high) {
  const YAML::Node node = take(name);
  if (!node || !short_list(node, path_of(name))) return;
  values.assign(node.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) read_number(node[i], fmt::format("{}.{}", path_of(name), i), values[i], low, high);
}

void FieldLoader::operator()(std::string_view name, Transform& value) {
  const YAML::Node node = take(name);
  if (!node) return;
  const std::string path = path_of(name);
  constexpr double kFar = 1e6;  // metres; nothing of ours stands farther away
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  const bool flat = node.IsSequence() && node.size() == 16;
  bool shaped = flat || (node.IsSequence() && node.size() == 4);
  for (std::size_t row = 0; shaped && row < 4; ++row) {
    shaped = flat || (node[row].IsSequence() && node[row].size() == 4);
    for (std::size_t column = 0; shaped && column < 4; ++column)
      read_number(flat ? node[4 * row + column] : node[row][column], fmt::format("{}.{}.{}", path, row, column),
                  matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)), -kFar, kFar);
  }
  if (!shaped) return problem(node, path, fmt::format("= {}, expected 4 rows of 4 numbers, or all 16", shown(node)));
  if (!is_rigid(matrix)) return problem(node, path, "is not rigid: expected a rotation (to 1e-3), a translation and the row [0, 0, 0, 1]");
  // Files carry few digits; the nearest rotation is what was meant.
  value = Transform::Identity();
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool exact = (rotation * rotation.transpose()).isIdentity(1e-12);
  value.linear() = exact ? rotation : Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  value.translation() = matrix.topRightCorner<3, 1>();
}

void FieldLoader::report_unknown_keys() const {
  for (const auto& entry : map_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const auto nearest = std::min_element(known_.begin(), known_.end(), [&](const std::string& a, const std::string& b) {
      return edit_distance(key, a) < edit_distance(key, b);
    });
    const bool close = nearest != known_.end() && key.size() < 64 && edit_distance(key, *nearest) <= 1 + nearest->size() / 3;
    problem(entry.first, path_of(key.substr(0, 60)),
                  close ? fmt::format("is not a key; did you mean {}?", *nearest)
                        : fmt::format("is not a key; here are {}", fmt::join(known_, ", ")));
  }
}

}  // namespace gfp::config
