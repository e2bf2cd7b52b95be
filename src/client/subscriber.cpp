#include "gfp/client/subscriber.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <zmq.hpp>

#include "client/client_socket.hpp"
#include "gfp/v1/envelope.pb.h"
#include "recording/compression.hpp"
#include "wire/bounded_parse.hpp"
#include "wire/sensor_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {
namespace {

constexpr std::int64_t kMaxMessageBytes = 256 << 20;

/// What was last heard of a topic.
struct Heard {
  std::uint64_t session = 0, seq = 0;
};

std::vector<std::string> endpoints_for(const std::vector<std::string>& topics, const SubscriberOptions& options) {
  if (!options.endpoints.empty()) return options.endpoints;
  std::set<std::string> names;
  for (const std::string& topic : topics) {
    names.emplace(wire::endpoint_of(topic));
    if (wire::kSensorPrefix.starts_with(topic)) names.emplace("sensor");  // a prefix of everything
  }
  std::vector<std::string> endpoints;
  for (const std::string& name : names) endpoints.push_back(wire::default_endpoint(name));
  return endpoints;
}

std::string text_of(const zmq::message_t& part) { return {part.data<char>(), part.size()}; }

/// The blob as it was before it was coded. Errors: kCorruptData, kTooLarge, kUnsupported (a coding that this client does not know).
Result<void> blob_of(v1::Envelope::Encoding encoding, const zmq::message_t& part, std::string& blob) {
  const std::string_view bytes(part.data<char>(), part.size());
  if (encoding == v1::Envelope::ENCODING_RAW) {
    blob.assign(bytes);
    return {};
  }
  if (encoding != v1::Envelope::ENCODING_ZSTD) return failure(ErrorCode::kUnsupported, fmt::format("encoding {}, expected raw or zstd", static_cast<int>(encoding)));
  const auto size = zstd_content_size(bytes, kMaxMessageBytes);
  if (!size) return tl::unexpected(size.error());
  return decompress("zstd", bytes, *size, blob);
}

}  // namespace

struct Subscriber::Sockets {
  SubscriberOptions options;
  zmq::context_t context{1};
  zmq::socket_t socket{context, zmq::socket_type::sub};
  std::map<std::string, Heard> heard;
  SubscriberCounts counts;
  Nanoseconds last_heard = monotonic_now();

  Result<Message> read(const std::vector<zmq::message_t>& parts);
  void count(const Message& message, std::size_t bytes);
};

Subscriber::Subscriber(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
Subscriber::Subscriber(Subscriber&&) noexcept = default;
Subscriber& Subscriber::operator=(Subscriber&&) noexcept = default;
Subscriber::~Subscriber() = default;

Result<Subscriber> Subscriber::connect(const std::vector<std::string>& topics, const SubscriberOptions& options) {
  for (const std::string& topic : topics)
    if (!topic.starts_with('/')) return failure(ErrorCode::kInvalidArgument, fmt::format("topic = {}, expected it to begin with /", topic));
  auto sockets = std::make_unique<Sockets>();
  sockets->options = options;
  zmq::socket_t& socket = sockets->socket;
  if (auto prepared = prepare_client(socket, options.curve); !prepared) return tl::unexpected(prepared.error());
  socket.set(zmq::sockopt::rcvhwm, options.high_water_mark);
  socket.set(zmq::sockopt::maxmsgsize, kMaxMessageBytes);
  for (const std::string& topic : topics) socket.set(zmq::sockopt::subscribe, topic);
  for (const std::string& endpoint : endpoints_for(topics, options)) {
    try {
      socket.connect(endpoint);
    } catch (const zmq::error_t& error) {
      return failure(ErrorCode::kIo, fmt::format("{}: {}", endpoint, error.what()));
    }
  }
  return Subscriber(std::move(sockets));
}

Result<Message> Subscriber::receive(std::chrono::milliseconds timeout) {
  try {
    std::array<zmq::pollitem_t, 1> items = {{{sockets_->socket.handle(), 0, ZMQ_POLLIN, 0}}};
    if (zmq::poll(items, timeout) == 0) return failure(ErrorCode::kTimeout, fmt::format("nothing in {} ms", timeout.count()));
    constexpr std::size_t kMaxParts = 8;
    std::vector<zmq::message_t> parts;
    bool more = true;
    while (more) {
      zmq::message_t part;
      if (!sockets_->socket.recv(part, zmq::recv_flags::dontwait)) break;
      more = part.more();
      if (parts.size() < kMaxParts) parts.push_back(std::move(part));
    }
    return sockets_->read(parts);
  } catch (const zmq::error_t& error) {  // a signal, above all
    if (error.num() == EINTR) return failure(ErrorCode::kTimeout, "interrupted");
    return failure(ErrorCode::kIo, error.what());
  }
}

Result<Message> Subscriber::Sockets::read(const std::vector<zmq::message_t>& parts) {
  v1::Envelope envelope;
  const auto skip = [&](std::string what) {
    ++counts.corrupt;
    return failure(ErrorCode::kCorruptData, std::move(what));
  };
  if (parts.size() < 3 || parts.size() > 4) return skip(fmt::format("a message of {} parts, expected topic, envelope, payload and perhaps a blob", parts.size()));
  if (auto parsed = wire::parse_bounded({parts[1].data<std::byte>(), parts[1].size()}, wire::kMaxEnvelopeBytes, envelope); !parsed)
    return skip(parsed.error().what);
  Message message;
  message.topic = text_of(parts[0]);
  message.schema = envelope.schema();
  message.schema_hash = envelope.schema_hash();
  message.session = envelope.session();
  message.seq = envelope.seq();
  message.dropped_since_last = envelope.dropped_since_last();
  message.stamps = {Nanoseconds(envelope.stamp_sensor_ns()), Nanoseconds(envelope.stamp_monotonic_ns()), Nanoseconds(envelope.stamp_capture_ns())};
  message.published = Nanoseconds(envelope.stamp_publish_ns());
  message.age_s = std::chrono::duration<double>(realtime_now() - message.published).count();
  message.payload = text_of(parts[2]);
  if (parts.size() == 4)
    if (auto blob = blob_of(envelope.encoding(), parts[3], message.blob); !blob) return skip(message.topic + ": " + blob.error().what);
  std::size_t bytes = 0;
  for (const zmq::message_t& part : parts) bytes += part.size();
  count(message, bytes);
  return message;
}

void Subscriber::Sockets::count(const Message& message, std::size_t bytes) {
  last_heard = monotonic_now();
  ++counts.received;
  counts.bytes += bytes;
  if (message.age_s > options.stale_after_s) ++counts.stale;
  constexpr std::size_t kMaxTopics = 100'000;  // ids of objects rise without an end
  if (heard.size() > kMaxTopics) heard.clear();
  const auto [entry, is_first] = heard.try_emplace(message.topic);
  if (!is_first && entry->second.session != message.session) ++counts.restarts;
  else if (!is_first && message.seq > entry->second.seq + 1) counts.missed += message.seq - entry->second.seq - 1;
  entry->second = {message.session, message.seq};
}

const SubscriberCounts& Subscriber::counts() const { return sockets_->counts; }

double Subscriber::silent_for_s() const { return std::chrono::duration<double>(monotonic_now() - sockets_->last_heard).count(); }

Result<DepthImage> depth_image(const Message& message) {
  v1::DepthImage header;
  if (message.schema != header.GetTypeName())
    return failure(ErrorCode::kUnsupported, fmt::format("{} carries {}, expected {}", message.topic, message.schema, header.GetTypeName()));
  if (auto parsed = wire::parse_bounded(wire::as_bytes(message.payload), wire::kMaxImageHeaderBytes, header); !parsed) return tl::unexpected(parsed.error());
  return wire::depth_from(header, wire::as_bytes(message.blob));
}

}  // namespace gfp
