#include "wire/message_json.hpp"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <memory>

#include "gfp/v1/scene.pb.h"
#include "gfp/v1/sensor.pb.h"
#include "gfp/v1/status.pb.h"
#include "wire/bounded_parse.hpp"

namespace gfp::wire {
namespace {

/// What travels as a payload. Naming them also keeps their files in the program, without which the pool would not know them.
const google::protobuf::Message* prototype_of(const std::string& schema) {
  const google::protobuf::Message* const known[] = {
      &v1::Scene::default_instance(),      &v1::ObjectUpdate::default_instance(), &v1::Topology::default_instance(),
      &v1::DepthImage::default_instance(), &v1::ColorImage::default_instance(),   &v1::CameraInfo::default_instance(),
      &v1::SensorStatus::default_instance(), &v1::DaemonStatus::default_instance(), &v1::LogRecord::default_instance()};
  for (const auto* prototype : known)
    if (prototype->GetTypeName() == schema) return prototype;
  return nullptr;
}

Result<std::unique_ptr<google::protobuf::Message>> parse(const std::string& schema, std::string_view payload) {
  const google::protobuf::Message* prototype = prototype_of(schema);
  if (prototype == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("schema {} is not one of ours", schema.substr(0, 80)));
  std::unique_ptr<google::protobuf::Message> message(prototype->New());
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxSceneBytes, *message); !parsed) return tl::unexpected(parsed.error());
  return message;
}

void shorten(nlohmann::ordered_json& json) {
  constexpr std::size_t kLongText = 60, kLongArray = 16;
  if (json.is_string() && json.get_ref<const std::string&>().size() > kLongText) {
    const std::string& text = json.get_ref<const std::string&>();
    json = fmt::format("{}... ({} characters)", text.substr(0, kLongText / 2), text.size());
  }
  if (json.is_array() && json.size() > kLongArray && json[0].is_number()) json = fmt::format("[{} numbers]", json.size());
  if (json.is_structured())
    for (auto& value : json) shorten(value);
}

}  // namespace

Result<nlohmann::ordered_json> payload_json(const std::string& schema, std::string_view payload) {
  const auto message = parse(schema, payload);
  if (!message) return tl::unexpected(message.error());
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  if (!google::protobuf::util::MessageToJsonString(**message, &text, options).ok())
    return failure(ErrorCode::kCorruptData, fmt::format("{} cannot be written as JSON", schema));
  return nlohmann::ordered_json::parse(text);
}

Result<std::string> payload_text(const std::string& schema, std::string_view payload) {
  auto json = payload_json(schema, payload);
  if (!json) return tl::unexpected(json.error());
  shorten(*json);
  return json->dump(2);
}

}  // namespace gfp::wire
