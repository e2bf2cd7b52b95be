#include "publish/outlet.hpp"

#include <google/protobuf/descriptor.h>

#include "wire/schema.hpp"

namespace gfp {
namespace {

/// The blob's owner travels as the hint of ZeroMQ's free function, which runs on an I/O thread when the last byte is sent.
zmq::message_t message_of(Outlet::Blob blob) {
  if (blob.bytes.empty()) return zmq::message_t();
  auto owner = std::make_unique<std::shared_ptr<const void>>(std::move(blob.owner));
  const auto release = [](void*, void* hint) { delete static_cast<std::shared_ptr<const void>*>(hint); };
  // ZeroMQ never writes into a message that it sends.
  return zmq::message_t(const_cast<std::byte*>(blob.bytes.data()), blob.bytes.size(), release, owner.release());
}

zmq::message_t message_of(const google::protobuf::MessageLite& message) {
  zmq::message_t bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data<std::uint8_t>());
  return bytes;
}

}  // namespace

std::uint64_t Outlet::hash_of(const google::protobuf::Descriptor& descriptor) {
  const auto [entry, is_new] = schema_hashes_.try_emplace(&descriptor, 0);
  if (is_new) entry->second = wire::schema_hash(descriptor);
  return entry->second;
}

void Outlet::send(const std::string& topic, const google::protobuf::Message& payload, const Stamps& stamps, std::uint64_t dropped, Blob blob) {
  v1::Envelope envelope;
  envelope.set_schema(payload.GetDescriptor()->full_name());
  envelope.set_schema_hash(hash_of(*payload.GetDescriptor()));
  envelope.set_session(session_);
  envelope.set_seq(next_seq_[topic]++);
  envelope.set_stamp_sensor_ns(stamps.sensor.count());
  envelope.set_stamp_capture_ns(stamps.realtime.count());
  envelope.set_stamp_monotonic_ns(stamps.monotonic.count());
  envelope.set_stamp_publish_ns(realtime_now().count());
  envelope.set_dropped_since_last(dropped);
  envelope.set_encoding(blob.encoding);
  zmq::message_t parts[] = {zmq::message_t(topic.data(), topic.size()), message_of(envelope), message_of(payload), message_of(std::move(blob))};
  const std::size_t count = parts[3].size() > 0 ? 4 : 3;
  for (std::size_t i = 0; i < count; ++i) bytes_ += parts[i].size();
  ++messages_;
  for (std::size_t i = 0; i < count; ++i)
    socket_.socket.send(parts[i], i + 1 < count ? zmq::send_flags::sndmore | zmq::send_flags::dontwait : zmq::send_flags::dontwait);
}

}  // namespace gfp
