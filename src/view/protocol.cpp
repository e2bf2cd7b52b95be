#include "view/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gfp::view {
namespace {

using Json = nlohmann::json;

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

std::string server_info(std::string_view name, std::uint64_t session) {
  return Json{{"op", "serverInfo"}, {"name", name}, {"capabilities", Json::array()}, {"supportedEncodings", {"protobuf"}}, {"metadata", Json::object()}, {"sessionId", fmt::format("{:016x}", session)}}.dump();
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

std::string message_header(std::uint32_t subscription, std::uint64_t log_time_ns) {
  std::string header(13, '\1');
  for (std::size_t i = 0; i < 4; ++i) header[1 + i] = static_cast<char>(subscription >> (8 * i) & 0xFFU);
  for (std::size_t i = 0; i < 8; ++i) header[5 + i] = static_cast<char>(log_time_ns >> (8 * i) & 0xFFU);
  return header;
}

}  // namespace gfp::view
