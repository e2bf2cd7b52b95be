#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"

namespace gfp::view {

/// The Foxglove WebSocket protocol, version 1, as far as a publisher needs it: JSON texts of both directions and the header of binary
/// messages. Pure functions; the sockets are elsewhere.

inline constexpr std::string_view kSubprotocols[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};  ///< The newer first.

/// The first of ours that the client offers in Sec-WebSocket-Protocol (comma-separated); empty: none.
std::string_view choose_subprotocol(std::string_view offered);

/// One topic as clients see it. Ids are unique while the daemon runs.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;  ///< Fully qualified, as in `foxglove.PointCloud`.
  std::string schema;       ///< FileDescriptorSet that defines it.
};

/// Of a recording that is played and may be steered: what of it there is, CLOCK_REALTIME, and how it is played as the client comes.
struct PlaybackRange {
  Nanoseconds begin{}, end{};
  bool is_paused = false;
  double speed = 1;
};

/// With a range the capabilities `time` and `playbackControl` are offered; our page finds the present state in `metadata`.
std::string server_info(std::string_view name, std::uint64_t session, const std::optional<PlaybackRange>& playback = {}, bool has_services = false);

/// Something that clients may ask for, with the messages of question and answer (schemas as in Channel).
struct Service {
  std::uint32_t id = 0;
  std::string name;
  std::string request_name, request_schema;
  std::string response_name, response_schema;
};
std::string advertise_services(std::span<const Service> services);
std::string service_failure(std::uint32_t service, std::uint32_t call, std::string_view message);
std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view payload);  ///< Binary, opcode 3.
std::string advertise(std::span<const Channel> channels);

enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };
std::string status(StatusLevel level, std::string_view message);

/// What a client may say. A subscription id is the client's own; messages carry it back.
struct Subscribe {
  struct Item {
    std::uint32_t subscription = 0, channel = 0;
  };
  std::vector<Item> items;
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};
struct Other {
  std::string op;  ///< Well-formed, but nothing that we offer.
};
using ClientMessage = std::variant<Subscribe, Unsubscribe, Other>;

/// What a client's player bar asks of a replay.
struct PlaybackRequest {
  bool play = false;                 ///< Else: pause.
  double speed = 1;                  ///< Above 0, at most 100.
  std::optional<Nanoseconds> seek;   ///< CLOCK_REALTIME of recording.
  std::string id;                    ///< The client's own; the answer carries it back.
};
/// A call of a service, in protobuf.
struct ServiceCall {
  std::uint32_t service = 0, call = 0;  ///< `call` is the client's own.
  std::string payload;
};
using ClientBinary = std::variant<PlaybackRequest, ServiceCall>;

inline constexpr std::size_t kMaxRequestIdBytes = 256;

/// Errors: kCorruptData (too short, an opcode that nobody offered, numbers out of range), kTooLarge.
Result<ClientBinary> parse_client_binary(std::string_view bytes);

enum class PlaybackStatus : std::uint8_t { kPlaying = 0, kPaused = 1, kBuffering = 2, kEnded = 3 };
struct PlaybackState {
  PlaybackStatus status = PlaybackStatus::kPlaying;
  Nanoseconds time{};     ///< CLOCK_REALTIME of recording.
  double speed = 1;
  bool did_seek = false;
  std::string request_id; ///< Of the request that it answers; else empty.
};

/// Binary messages of the server: opcode 5, and opcode 2 (the time that a replay has come to).
std::string playback_state(const PlaybackState& state);
std::string time_message(Nanoseconds time);

inline constexpr std::size_t kMaxClientMessageBytes = 64 * 1024;
inline constexpr std::size_t kMaxItems = 1000;  ///< Subscriptions in one message.

/// Errors: kTooLarge, kCorruptData (not JSON, no `op`, a field of another kind).
Result<ClientMessage> parse_client_message(std::string_view text);

/// opcode 1, subscription id, log time: what stands before the payload of a message (13 bytes, little-endian).
std::string message_header(std::uint32_t subscription, std::uint64_t log_time_ns);

}  // namespace gfp::view
