#include "config/daemon_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "config/field_loader.hpp"
#include "config/field_writer.hpp"
#include "config/yaml_document.hpp"

namespace gfp {
namespace {

bool is_topic_word(std::string_view name) {
  return !name.empty() && name.size() <= 64 &&
         std::all_of(name.begin(), name.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

Result<void> validate_sensors(const std::vector<SensorConfig>& sensors) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string& name = sensors[i].name;
    if (!is_topic_word(name))
      return failure(ErrorCode::kInvalidArgument, fmt::format("sensors.{}.name = {}, expected 1 to 64 of a-z, 0-9 and _", i, name));
    if (!names.insert(name).second)
      return failure(ErrorCode::kInvalidArgument, fmt::format("sensors.{}.name = {}, expected a name no other sensor has", i, name));
  }
  return {};
}

Result<void> validate_endpoints(const char* key, const std::vector<std::string>& endpoints, const PublishOptions& publish) {
  const bool may_use_tcp = publish.insecure || !publish.curve_key.empty();
  for (const std::string& endpoint : endpoints) {
    const bool ipc = endpoint.starts_with("ipc://"), inproc = endpoint.starts_with("inproc://"), tcp = endpoint.starts_with("tcp://");
    if (!ipc && !inproc && !tcp)
      return failure(ErrorCode::kInvalidArgument, fmt::format("publish.{} = {}, expected ipc://, inproc:// or tcp://", key, endpoint));
    if (tcp && !may_use_tcp)
      return failure(ErrorCode::kInvalidArgument,
                     fmt::format("publish.{} = {}, expected ipc:// (for tcp give publish.curve_key and publish.authorized_keys, or allow it "
                                 "unencrypted and for everybody with publish.insecure = true or --insecure)", key, endpoint));
  }
  return {};
}

/// A scalar or flow value at a dotted path, as the document that would say the same.
Result<YAML::Node> document_of_setting(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == 0 || equals == std::string::npos)
    return failure(ErrorCode::kInvalidArgument, fmt::format("--set {}: expected path.to.key=value", setting.substr(0, 80)));
  auto value = config::parse_yaml(std::string_view(setting).substr(equals + 1), "--set " + setting.substr(0, 80));
  if (!value) return value;
  YAML::Node node = *value;
  if (node.IsNull()) node = YAML::Node("");
  std::string path = setting.substr(0, equals);
  if (std::count(path.begin(), path.end(), '.') >= config::kMaxDepth)
    return failure(ErrorCode::kTooLarge, fmt::format("--set: a path of more than {} keys", config::kMaxDepth));
  while (true) {
    const std::size_t dot = path.rfind('.');
    YAML::Node outer(YAML::NodeType::Map);
    outer.force_insert(dot == std::string::npos ? path : path.substr(dot + 1), node);
    node.reset(outer);  // operator= would change what `outer` holds
    if (dot == std::string::npos) return node;
    path.resize(dot);
  }
}

}  // namespace

Result<void> validate(const DaemonOptions& options) {
  if (Result<void> valid = validate_sensors(options.sensors); !valid) return valid;
  const PublishOptions& publish = options.publish;
  for (const auto& [key, endpoints] : {std::pair{"sensor_endpoints", &publish.sensor_endpoints}, {"state_endpoints", &publish.state_endpoints}, {"control_endpoints", &publish.control_endpoints}})
    if (Result<void> valid = validate_endpoints(key, *endpoints, publish); !valid) return valid;
  if (!publish.curve_key.empty() && publish.authorized_keys.empty())
    return failure(ErrorCode::kInvalidArgument, "publish.authorized_keys is empty, expected a folder of .pub files beside publish.curve_key");
  if (options.robot.min_reach_m >= options.robot.max_reach_m)
    return failure(ErrorCode::kInvalidArgument, fmt::format("robot.min_reach_m = {}, expected less than max_reach_m = {}", options.robot.min_reach_m, options.robot.max_reach_m));
  if (!is_topic_word(options.recording.prefix))
    return failure(ErrorCode::kInvalidArgument, fmt::format("recording.prefix = {}, expected 1 to 64 of a-z, 0-9 and _", options.recording.prefix));
  const auto& cloud = options.pipeline.cloud;
  if (cloud.min_depth_m >= cloud.max_depth_m)
    return failure(ErrorCode::kInvalidArgument,
                   fmt::format("pipeline.cloud.min_depth_m = {}, expected less than max_depth_m = {}", cloud.min_depth_m, cloud.max_depth_m));
  return {};
}

}  // namespace gfp

namespace gfp::config {
namespace {

/// The layers from the bottom: defaults, gripper file, the document, the settings. The gripper file is named by an upper
/// layer, so these are read twice: once to learn its name.
Result<DaemonOptions> overlay(DaemonOptions options, const YAML::Node& document, const std::string& source,
                              const std::vector<std::string>& settings) {
  if (Result<void> loaded = load_fields(document, source, options); !loaded) return tl::unexpected(loaded.error());
  for (const std::string& setting : settings) {
    const auto change = document_of_setting(setting);
    if (!change) return tl::unexpected(change.error());
    if (Result<void> loaded = load_fields(*change, "--set " + setting.substr(0, 80), options, false); !loaded)
      return tl::unexpected(loaded.error());
  }
  return options;
}

void flatten(const YAML::Node& node, const std::string& path, std::map<std::string, std::string>& values) {
  if (node.IsMap()) {
    for (const auto& entry : node) flatten(entry.second, path + (path.empty() ? "" : ".") + entry.first.Scalar(), values);
  } else if (node.IsSequence() && node.size() > 0 && node[0].IsMap()) {
    for (std::size_t i = 0; i < node.size(); ++i) flatten(node[i], fmt::format("{}.{}", path, i), values);
  } else {
    YAML::Emitter out;
    out << YAML::Flow << node;
    values[path] = node.IsScalar() ? node.Scalar() : out.c_str();
  }
}

}  // namespace

std::map<std::string, std::string> parameters(const DaemonOptions& options) {
  std::map<std::string, std::string> values;
  flatten(YAML::Load(to_yaml(options)), "", values);
  return values;
}

Result<DaemonOptions> with_settings(const DaemonOptions& options, const std::vector<std::string>& settings) {
  auto changed = overlay(options, YAML::Node(YAML::NodeType::Map), "configuration", settings);
  if (!changed) return changed;
  if (Result<void> valid = validate(*changed); !valid) return tl::unexpected(valid.error());
  return changed;
}

Result<DaemonOptions> parse_daemon_options(std::string_view text, const std::string& source, const std::vector<std::string>& settings) {
  const auto document = parse_yaml(text, source);
  if (!document) return tl::unexpected(document.error());
  auto options = overlay({}, *document, source, settings);
  if (options && !options->gripper_file.empty()) {
    const auto gripper = load_gripper_file(std::filesystem::path(source).parent_path() / options->gripper_file);
    if (!gripper) return tl::unexpected(gripper.error());
    DaemonOptions with_gripper;
    with_gripper.pipeline.gripper = *gripper;
    options = overlay(with_gripper, *document, source, settings);
  }
  if (!options) return options;
  if (Result<void> valid = validate(*options); !valid)
    return failure(valid.error().code, fmt::format("{}: {}", source, valid.error().what));
  return options;
}

Result<DaemonOptions> load_daemon_options(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  if (file.empty()) return parse_daemon_options("", "configuration", settings);
  const auto text = read_text(file);
  if (!text) return tl::unexpected(text.error());
  return parse_daemon_options(*text, file.string(), settings);
}

Result<Gripper> load_gripper_file(const std::filesystem::path& file) {
  const auto text = read_text(file);
  if (!text) return tl::unexpected(text.error());
  const auto document = parse_yaml(*text, file.string());
  if (!document) return tl::unexpected(document.error());
  Gripper gripper;
  if (Result<void> loaded = load_fields(*document, file.string(), gripper); !loaded) return tl::unexpected(loaded.error());
  return gripper;
}

std::string to_yaml(const DaemonOptions& options) { return fields_to_yaml(options); }

std::string schema_json() {
  DaemonOptions defaults;
  nlohmann::ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "gfpd configuration"}};
  schema.update(FieldSchema::of(defaults));
  return schema.dump(2);
}

}  // namespace gfp::config
