#include "view/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace gfp::view {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kEncoding = "protobuf";
constexpr std::int64_t kPerSecond = 1'000'000'000;
enum Opcode : std::uint8_t { kMessageData = 1, kTime = 2, kServiceResponse = 3, kPlaybackState = 5 };  // of the server
enum ClientOpcode : std::uint8_t { kServiceRequest = 2, kPlaybackControl = 3 };

std::string base64(std::string_view bytes) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kAlphabet[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// An array of at most kMaxItems; throws Json's exceptions, as all readers below.
const Json& list_at(const Json& message, const char* key) {
  const Json& list = message.at(key);
  if (!list.is_array() || list.size() > kMaxItems) throw std::length_error(fmt::format("{}: expected a list of at most {}", key, kMaxItems));
  return list;
}

std::uint32_t id_of(const Json& value) {
  const auto id = value.get<std::uint64_t>();
  if (!value.is_number_integer() || id > 0xFFFF'FFFFU) throw std::out_of_range("an id is no 32-bit number");
  return static_cast<std::uint32_t>(id);
}

Json json_time(Nanoseconds time) { return {{"sec", time.count() / kPerSecond}, {"nsec", time.count() % kPerSecond}}; }

/// Little-endian, whatever the machine; the bytes are there.
template <class Number>
Number take(std::string_view& bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) bits |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
  bytes.remove_prefix(sizeof(Number));
  return static_cast<Number>(bits);
}

void put(std::string& bytes, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
}

Result<PlaybackRequest> playback_request(std::string_view bytes) {
  constexpr std::size_t kFixed = 1 + 4 + 1 + 8 + 4;
  const auto corrupt = [](std::string what) { return failure(ErrorCode::kCorruptData, "a playback request " + what); };
  if (bytes.size() < kFixed) return corrupt(fmt::format("of {} bytes, expected at least {}", bytes.size(), kFixed));
  const auto command = take<std::uint8_t>(bytes);
  const auto speed = std::bit_cast<float>(take<std::uint32_t>(bytes));
  const auto has_seek = take<std::uint8_t>(bytes);
  const auto seek_ns = take<std::uint64_t>(bytes);
  const auto id_length = take<std::uint32_t>(bytes);
  if (command > 1) return corrupt(fmt::format("with command {}, expected 0 (play) or 1 (pause)", command));
  if (!(speed > 0 && speed <= 100)) return corrupt(fmt::format("with speed {}, expected above 0 and at most 100", speed));
  if (has_seek > 1 || seek_ns > static_cast<std::uint64_t>(INT64_MAX)) return corrupt(fmt::format("to seek {} ({})", seek_ns, has_seek));
  if (id_length > kMaxRequestIdBytes || id_length != bytes.size()) return corrupt(fmt::format("with an id of {} bytes, {} follow, at most {} are read", id_length, bytes.size(), kMaxRequestIdBytes));
  PlaybackRequest request{command == 0, speed, std::nullopt, std::string(bytes)};
  if (has_seek == 1) request.seek = Nanoseconds(static_cast<std::int64_t>(seek_ns));
  return request;
}

Result<ServiceCall> service_call(std::string_view bytes) {
  constexpr std::size_t kFixed = 3 * 4;
  if (bytes.size() < kFixed) return failure(ErrorCode::kCorruptData, fmt::format("a service call of {} bytes, expected at least {}", bytes.size(), kFixed));
  const auto service = take<std::uint32_t>(bytes), call = take<std::uint32_t>(bytes), length = take<std::uint32_t>(bytes);
  const std::string_view encoding = bytes.substr(0, length);
  if (encoding.size() != length || encoding != kEncoding) return failure(ErrorCode::kCorruptData, fmt::format("a service call encoded in {} bytes, expected {}", length, kEncoding));
  return ServiceCall{service, call, std::string(bytes.substr(length))};
}

ClientMessage message_of(const Json& message) {
  const std::string op = message.at("op").get<std::string>();
  if (op == "subscribe") {
    Subscribe subscribe;
    for (const Json& item : list_at(message, "subscriptions")) subscribe.items.push_back({id_of(item.at("id")), id_of(item.at("channelId"))});
    return subscribe;
  }
  if (op == "unsubscribe") {
    Unsubscribe unsubscribe;
    for (const Json& id : list_at(message, "subscriptionIds")) unsubscribe.subscriptions.push_back(id_of(id));
    return unsubscribe;
  }
  return Other{op.substr(0, 40)};
}

}  // namespace

std::string_view choose_subprotocol(std::string_view offered) {
  for (const std::string_view ours : kSubprotocols)
    for (std::string_view rest = offered; !rest.empty();) {
      const std::size_t comma = rest.find(',');
      if (trimmed(rest.substr(0, comma)) == ours) return ours;
      rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    }
  return {};
}

std::string server_info(std::string_view name, std::uint64_t session, const std::optional<PlaybackRange>& playback, bool has_services) {
  Json info{{"op", "serverInfo"}, {"name", name}, {"capabilities", Json::array()}, {"supportedEncodings", {"protobuf"}}, {"metadata", Json::object()}, {"sessionId", fmt::format("{:016x}", session)}};
  if (playback) {
    info["capabilities"] = {"time", "playbackControl"};
    info["dataStartTime"] = json_time(playback->begin);
    info["dataEndTime"] = json_time(playback->end);
    info["metadata"] = {{"playback", playback->is_paused ? "paused" : "playing"}, {"speed", fmt::format("{}", playback->speed)}};
  }
  if (has_services) info["capabilities"].push_back("services");
  return info.dump();
}

std::string advertise_services(std::span<const Service> services) {
  Json list = Json::array();
  const auto message = [](const std::string& name, const std::string& schema) {
    return Json{{"encoding", kEncoding}, {"schemaName", name}, {"schema", base64(schema)}, {"schemaEncoding", kEncoding}};
  };
  for (const Service& service : services)
    list.push_back({{"id", service.id}, {"name", service.name}, {"type", service.request_name}, {"request", message(service.request_name, service.request_schema)}, {"response", message(service.response_name, service.response_schema)}});
  return Json{{"op", "advertiseServices"}, {"services", std::move(list)}}.dump();
}

std::string service_failure(std::uint32_t service, std::uint32_t call, std::string_view message) {
  return Json{{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", message}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view payload) {
  std::string message(1, static_cast<char>(kServiceResponse));
  put(message, service, 4);
  put(message, call, 4);
  put(message, kEncoding.size(), 4);
  return message.append(kEncoding).append(payload);
}

std::string advertise(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels)
    list.push_back({{"id", channel.id}, {"topic", channel.topic}, {"encoding", "protobuf"}, {"schemaName", channel.schema_name}, {"schema", base64(channel.schema)}, {"schemaEncoding", "protobuf"}});
  return Json{{"op", "advertise"}, {"channels", std::move(list)}}.dump();
}

std::string status(StatusLevel level, std::string_view message) {
  return Json{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}}.dump(-1, ' ', false, Json::error_handler_t::replace);  // it may quote what a client sent
}

Result<ClientMessage> parse_client_message(std::string_view text) {
  if (text.size() > kMaxClientMessageBytes) return failure(ErrorCode::kTooLarge, fmt::format("a message of {} bytes, at most {} are read", text.size(), kMaxClientMessageBytes));
  try {
    return message_of(Json::parse(text));
  } catch (const std::exception& error) {
    return failure(ErrorCode::kCorruptData, error.what());
  }
}

Result<ClientBinary> parse_client_binary(std::string_view bytes) {
  if (bytes.empty()) return failure(ErrorCode::kCorruptData, "a binary message without an opcode");
  const auto opcode = take<std::uint8_t>(bytes);
  if (opcode == kPlaybackControl) return playback_request(bytes);
  if (opcode == kServiceRequest) return service_call(bytes);
  return failure(ErrorCode::kCorruptData, fmt::format("opcode {}: not offered by this server", opcode));
}

std::string message_header(std::uint32_t subscription, std::uint64_t log_time_ns) {
  std::string header(1, static_cast<char>(kMessageData));
  put(header, subscription, 4);
  put(header, log_time_ns, 8);
  return header;
}

std::string playback_state(const PlaybackState& state) {
  std::string message(1, static_cast<char>(kPlaybackState));
  put(message, static_cast<std::uint64_t>(state.status), 1);
  put(message, static_cast<std::uint64_t>(state.time.count()), 8);
  put(message, std::bit_cast<std::uint32_t>(static_cast<float>(state.speed)), 4);
  put(message, state.did_seek ? 1 : 0, 1);
  put(message, state.request_id.size(), 4);
  return message + state.request_id;
}

std::string time_message(Nanoseconds time) {
  std::string message(1, static_cast<char>(kTime));
  put(message, static_cast<std::uint64_t>(time.count()), 8);
  return message;
}

}  // namespace gfp::view
