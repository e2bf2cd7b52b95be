#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "config/field_loader.hpp"

namespace gfp::config {

/// The visitor that writes an options struct as YAML: every field, numbers with the fewest digits that read back the same.
class FieldWriter {
 public:
  explicit FieldWriter(YAML::Emitter& out) : out_(out) {}

  template <Number T>
  void operator()(std::string_view name, const T& value, std::type_identity_t<T>, std::type_identity_t<T>) {
    key(name) << number(value);
  }
  void operator()(std::string_view name, const bool& value) { key(name) << (value ? "true" : "false"); }
  void operator()(std::string_view name, const std::string& value) { key(name) << YAML::DoubleQuoted << value; }
  void operator()(std::string_view name, const std::string& value, const OneOf&) { key(name) << value; }
  void operator()(std::string_view name, const std::vector<std::string>& values) {
    key(name) << YAML::Flow << YAML::BeginSeq;
    for (const std::string& value : values) out_ << YAML::DoubleQuoted << value;
    out_ << YAML::EndSeq;
  }
  void operator()(std::string_view name, const std::vector<double>& values, double, double) {
    key(name) << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out_ << number(value);
    out_ << YAML::EndSeq;
  }
  void operator()(std::string_view name, const Transform& value) {
    key(name) << YAML::Flow << YAML::BeginSeq;
    for (int row = 0; row < 4; ++row) {
      out_ << YAML::Flow << YAML::BeginSeq;
      for (int column = 0; column < 4; ++column) out_ << number(value.matrix()(row, column));
      out_ << YAML::EndSeq;
    }
    out_ << YAML::EndSeq;
  }
  template <class Options>
  void section(std::string_view name, Options& options) {
    key(name);
    write(options);
  }
  template <class Options>
  void list(std::string_view name, std::vector<Options>& items) {
    key(name) << YAML::BeginSeq;
    for (Options& item : items) write(item);
    out_ << YAML::EndSeq;
  }
  template <class Options>
  void write(Options& options) {
    out_ << YAML::BeginMap;
    visit_fields(options, *this);
    out_ << YAML::EndMap;
  }

 private:
  YAML::Emitter& key(std::string_view name) { return out_ << YAML::Key << std::string(name) << YAML::Value; }
  template <Number T>
  static std::string number(T value) { return fmt::format("{}", value); }

  YAML::Emitter& out_;
};

/// All fields of `options` as a YAML document.
template <class Options>
std::string fields_to_yaml(Options options) {
  YAML::Emitter out;
  FieldWriter(out).write(options);
  return std::string(out.c_str()) + "\n";
}

/// The visitor that describes an options struct as a JSON Schema: types, bounds, defaults.
class FieldSchema {
 public:
  template <Number T>
  void operator()(std::string_view name, const T& value, std::type_identity_t<T> low, std::type_identity_t<T> high) {
    property(name) = {{"type", std::integral<T> ? "integer" : "number"}, {"default", value}, {"minimum", low}, {"maximum", high}};
  }
  void operator()(std::string_view name, const bool& value) { property(name) = {{"type", "boolean"}, {"default", value}}; }
  void operator()(std::string_view name, const std::string& value) { property(name) = {{"type", "string"}, {"default", value}}; }
  void operator()(std::string_view name, const std::string& value, const OneOf& choice) {
    property(name) = {{"type", "string"}, {"default", value}, {"enum", choice.values}};
  }
  void operator()(std::string_view name, const std::vector<std::string>& values) {
    property(name) = {{"type", "array"}, {"default", values}, {"items", {{"type", "string"}}}};
  }
  void operator()(std::string_view name, const std::vector<double>& values, double low, double high) {
    property(name) = {{"type", "array"}, {"default", values}, {"items", {{"type", "number"}, {"minimum", low}, {"maximum", high}}}};
  }
  void operator()(std::string_view name, const Transform&) {
    const nlohmann::json row = {{"type", "array"}, {"minItems", 4}, {"maxItems", 4}, {"items", {{"type", "number"}}}};
    property(name) = {{"type", "array"}, {"minItems", 4}, {"maxItems", 4}, {"items", row}};
  }
  template <class Options>
  void section(std::string_view name, Options& options) {
    property(name) = of(options);
  }
  template <class Options>
  void list(std::string_view name, std::vector<Options>&) {
    Options element;
    property(name) = {{"type", "array"}, {"items", of(element)}};
  }
  template <class Options>
  static nlohmann::ordered_json of(Options& options) {
    FieldSchema schema;
    visit_fields(options, schema);
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", schema.properties_}};
  }

 private:
  nlohmann::ordered_json& property(std::string_view name) { return properties_[std::string(name)]; }
  nlohmann::ordered_json properties_ = nlohmann::ordered_json::object();
};

}  // namespace gfp::config
