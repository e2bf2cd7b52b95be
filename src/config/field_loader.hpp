#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <concepts>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/fields.hpp"
#include "gfp/core/transform.hpp"

namespace gfp::config {

/// What is wrong with one document, a line each: `robot.yaml:12: pipeline.segmentation.min_points = 5, expected [10, 100000]`.
class Problems {
 public:
  /// `source` is a file, or a text of one line (`--set ...`), where line numbers say nothing.
  Problems(std::string source, bool is_file) : source_(std::move(source)), is_file_(is_file) {}

  void add(int line, std::string_view path, std::string_view what);
  bool empty() const { return count_ == 0; }
  /// kInvalidArgument with all lines; call only when not empty().
  Error error() const;

 private:
  static constexpr int kListed = 20;
  std::string source_, text_;
  bool is_file_;
  int count_ = 0;
};

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

/// The visitor that fills an options struct from a YAML mapping (see gfp/core/fields.hpp for the fields' forms). A key that
/// is absent leaves its member alone, so a file says only what differs. A list replaces the member; a mapping in its place
/// with indices as keys changes single elements (`--set sensors.0.name=front`).
class FieldLoader {
 public:
  FieldLoader(YAML::Node map, std::string path, Problems& problems);

  template <Number T>
  void operator()(std::string_view name, T& value, std::type_identity_t<T> low, std::type_identity_t<T> high) {
    if (const YAML::Node node = take(name)) read_number(node, path_of(name), value, low, high);
  }
  void operator()(std::string_view name, bool& value);
  void operator()(std::string_view name, std::string& value);
  void operator()(std::string_view name, std::string& value, const OneOf& choice);
  void operator()(std::string_view name, std::vector<std::string>& values);
  void operator()(std::string_view name, std::vector<double>& values, double low, double high);
  void operator()(std::string_view name, Transform& value);

  template <class Options>
  void section(std::string_view name, Options& options) {
    const YAML::Node node = take(name);
    if (node && !node.IsNull()) read_struct(node, path_of(name), options);
  }
  template <class Options>
  void list(std::string_view name, std::vector<Options>& items) {
    const YAML::Node node = take(name);
    if (!node || !list_or_indices(node, path_of(name), items.size())) return;
    if (node.IsMap()) {
      for (const auto& entry : node) {
        const auto index = static_cast<std::size_t>(std::stoul(entry.first.Scalar()));
        read_struct(entry.second, fmt::format("{}.{}", path_of(name), index), items[index]);
      }
      return;
    }
    items.assign(node.size(), Options{});
    for (std::size_t i = 0; i < items.size(); ++i) read_struct(node[i], fmt::format("{}.{}", path_of(name), i), items[i]);
  }

  /// Reports every key of the mapping that no field asked for, with the nearest one that exists.
  void report_unknown_keys() const;

 private:
  static constexpr std::size_t kMaxListItems = 64, kMaxTextBytes = 4096;

  template <Number T>
  void read_number(const YAML::Node& node, const std::string& path, T& value, T low, T high) {
    const std::string text = plain_scalar(node);
    T parsed{};
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    const char* kind = std::integral<T> ? "an integer" : "a number";
    const bool beyond = status == std::errc::result_out_of_range && end == text.data() + text.size();
    if (!beyond && (status != std::errc() || end != text.data() + text.size() || text.empty()))
      return problem(node, path, fmt::format("= {}, expected {} in [{}, {}]", shown(node), kind, low, high));
    if (beyond || !(low <= parsed && parsed <= high))  // the negation also refuses NaN
      return problem(node, path, fmt::format("= {}, expected [{}, {}]", text, low, high));
    value = parsed;
  }
  template <class Options>
  void read_struct(const YAML::Node& node, const std::string& path, Options& options) {
    if (!node.IsMap()) return problem(node, path, fmt::format("= {}, expected a mapping", shown(node)));
    FieldLoader loader(node, path, problems_);
    visit_fields(options, loader);
    loader.report_unknown_keys();
  }

  void problem(const YAML::Node& node, std::string_view path, std::string_view what) const;
  /// The value of a key, marked as asked for; an undefined node where the key is absent.
  YAML::Node take(std::string_view name);
  std::string path_of(std::string_view name) const;
  bool list_or_indices(const YAML::Node& node, const std::string& path, std::size_t size) const;
  bool short_list(const YAML::Node& node, const std::string& path) const;
  bool text_of(const YAML::Node& node, const std::string& path, std::string& value) const;
  static std::string plain_scalar(const YAML::Node& node);  ///< Unquoted text; empty where the node is something else.
  static std::string shown(const YAML::Node& node);         ///< For messages: short, one line.

  YAML::Node map_;
  std::string path_;
  Problems& problems_;
  std::vector<std::string> known_;
  int key_line_ = 0;  ///< Of the key taken last: an absent value (`key:`) has no place of its own.
};

/// Fills `options` from a document. Errors: kInvalidArgument, a line per problem.
template <class Options>
Result<void> load_fields(const YAML::Node& document, const std::string& source, Options& options, bool is_file = true) {
  Problems problems(source, is_file);
  Options loaded = options;
  if (document.IsMap()) {
    FieldLoader loader(document, "", problems);
    visit_fields(loaded, loader);
    loader.report_unknown_keys();
  } else if (!document.IsNull()) {
    problems.add(document.Mark().line, "the document", "expected to be a mapping");
  }
  if (!problems.empty()) return tl::unexpected(problems.error());
  options = std::move(loaded);
  return {};
}

}  // namespace gfp::config
