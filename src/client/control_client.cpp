#include "gfp/client/control_client.hpp"

#include <fmt/format.h>

#include <array>
#include <zmq.hpp>

#include "client/client_socket.hpp"
#include "gfp/v1/control.pb.h"
#include "wire/bounded_parse.hpp"
#include "wire/geometry_messages.hpp"
#include "wire/grasp_messages.hpp"
#include "wire/scene_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {
namespace {

constexpr std::size_t kMaxReplyBytes = 256U << 20U;

ErrorCode code_of(v1::ControlReply::Code code) {
  switch (code) {
    case v1::ControlReply::CODE_INVALID: return ErrorCode::kInvalidArgument;
    case v1::ControlReply::CODE_NOT_FOUND: return ErrorCode::kNotFound;
    case v1::ControlReply::CODE_BUSY:
    case v1::ControlReply::CODE_UNAVAILABLE: return ErrorCode::kTimeout;
    default: return ErrorCode::kCorruptData;
  }
}

std::map<std::string, std::string> plain(const v1::Parameters& parameters) { return {parameters.values().begin(), parameters.values().end()}; }

}  // namespace

struct ControlClient::Link {
  ControlOptions options;
  zmq::context_t context{1};
  zmq::socket_t socket{context, zmq::socket_type::dealer};
  std::uint64_t next_id = 1;

  /// Sends the request and waits for the reply with its id; answers to earlier requests that came too late are passed over.
  Result<v1::ControlReply> ask(v1::ControlRequest request);
  Result<v1::ControlReply> receive(std::chrono::milliseconds timeout);
};

Result<v1::ControlReply> ControlClient::Link::ask(v1::ControlRequest request) {
  request.set_id(next_id++);
  try {
    const std::string bytes = request.SerializeAsString();
    if (!socket.send(zmq::buffer(bytes), zmq::send_flags::dontwait)) return failure(ErrorCode::kTimeout, "too many requests wait for the daemon");
    const auto deadline = std::chrono::steady_clock::now() + options.timeout;
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      auto reply = receive(std::max(left, std::chrono::milliseconds(0)));
      if (!reply || reply->id() == request.id()) return reply;
    }
  } catch (const zmq::error_t& error) {
    return failure(ErrorCode::kIo, error.what());
  }
}

Result<v1::ControlReply> ControlClient::Link::receive(std::chrono::milliseconds timeout) {
  std::array<zmq::pollitem_t, 1> items = {{{socket.handle(), 0, ZMQ_POLLIN, 0}}};
  zmq::message_t part;
  if (zmq::poll(items, timeout) == 0 || !socket.recv(part, zmq::recv_flags::dontwait))
    return failure(ErrorCode::kTimeout, fmt::format("no answer in {} ms", options.timeout.count()));
  v1::ControlReply reply;
  if (auto parsed = wire::parse_bounded({part.data<std::byte>(), part.size()}, kMaxReplyBytes, reply); !parsed) return tl::unexpected(parsed.error());
  if (reply.code() != v1::ControlReply::CODE_OK) return failure(code_of(reply.code()), reply.error());
  return reply;
}

ControlClient::ControlClient(std::unique_ptr<Link> link) : link_(std::move(link)) {}
ControlClient::ControlClient(ControlClient&&) noexcept = default;
ControlClient& ControlClient::operator=(ControlClient&&) noexcept = default;
ControlClient::~ControlClient() = default;

Result<ControlClient> ControlClient::connect(const ControlOptions& options) {
  auto link = std::make_unique<Link>();
  link->options = options;
  if (auto prepared = prepare_client(link->socket, options.curve); !prepared) return tl::unexpected(prepared.error());
  link->socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(kMaxReplyBytes));
  const std::string endpoint = options.endpoint.empty() ? wire::default_endpoint("control") : options.endpoint;
  try {
    link->socket.connect(endpoint);
  } catch (const zmq::error_t& error) {
    return failure(ErrorCode::kIo, fmt::format("{}: {}", endpoint, error.what()));
  }
  return ControlClient(std::move(link));
}

Result<StateSnapshot> ControlClient::snapshot(const std::string& prefix) {
  v1::ControlRequest request;
  request.mutable_snapshot()->set_prefix(prefix);
  auto reply = link_->ask(std::move(request));
  if (!reply) return tl::unexpected(reply.error());
  StateSnapshot snapshot{reply->session(), {}};
  for (v1::Snapshot::Entry& entry : *reply->mutable_snapshot()->mutable_entries())
    snapshot.topics.push_back({std::move(*entry.mutable_topic()), std::move(*entry.mutable_schema()), entry.next_seq(), std::move(*entry.mutable_payload())});
  return snapshot;
}

Result<Scene> ControlClient::fit(const std::string& sensor, const std::optional<std::array<int, 4>>& region_px) {
  v1::ControlRequest request;
  request.mutable_fit()->set_sensor(sensor);
  if (region_px)
    for (const int edge : *region_px) request.mutable_fit()->add_region_px(static_cast<std::uint32_t>(std::max(edge, 0)));
  const auto reply = link_->ask(std::move(request));
  if (!reply) return tl::unexpected(reply.error());
  std::map<std::uint64_t, std::shared_ptr<const Topology>> topologies;
  for (const v1::Topology& sent : reply->fit().topologies()) {
    auto topology = wire::topology_from(sent);
    if (!topology) return tl::unexpected(topology.error());
    topologies[sent.hash()] = std::make_shared<const Topology>(std::move(*topology));
  }
  return wire::scene_from(reply->fit().scene(), [&](std::uint64_t hash) {
    const auto known = topologies.find(hash);
    return known == topologies.end() ? nullptr : known->second;
  });
}

Result<ReachableGrasp> ControlClient::best_grasp(std::uint64_t object, const std::string& sensor) {
  v1::ControlRequest request;
  request.mutable_grasp()->set_object(object);
  request.mutable_grasp()->set_sensor(sensor);
  const auto reply = link_->ask(std::move(request));
  if (!reply) return tl::unexpected(reply.error());
  const v1::ReachableGrasp& sent = reply->grasp();
  auto grasp = wire::grasp_from(sent.grasp());
  const auto tcp = wire::transform_from(sent.t_base_tcp(), "T_base_tcp");
  const auto parent = wire::transform_from(sent.t_base_parent(), "T_base_parent");
  const auto pregrasp = wire::transform_from(sent.t_base_pregrasp_tcp(), "T_base_pregrasp_tcp");
  if (!grasp) return tl::unexpected(grasp.error());
  for (const auto* transform : {&tcp, &parent, &pregrasp})
    if (!*transform) return tl::unexpected(transform->error());
  return ReachableGrasp{std::move(*grasp), *tcp, *parent, *pregrasp};
}

Result<std::map<std::string, std::string>> ControlClient::parameters(const std::vector<std::string>& prefixes) {
  v1::ControlRequest request;
  for (const std::string& prefix : prefixes) request.mutable_get_parameters()->add_prefixes(prefix);
  if (prefixes.empty()) request.mutable_get_parameters();
  return link_->ask(std::move(request)).map([](const v1::ControlReply& reply) { return plain(reply.parameters()); });
}

Result<RecorderState> ControlClient::recorder(RecorderAction action) {
  static_assert(static_cast<int>(RecorderAction::kTrigger) == static_cast<int>(v1::RecordRequest::ACTION_TRIGGER));
  v1::ControlRequest request;
  request.mutable_record()->set_action(static_cast<v1::RecordRequest::Action>(action));
  return link_->ask(std::move(request)).map([](const v1::ControlReply& reply) {
    const v1::Recording& sent = reply.recording();
    return RecorderState{sent.mode(), sent.state(), sent.file(), sent.files(), sent.messages(), sent.bytes(), sent.lost_messages(), sent.last_error()};
  });
}

Result<std::map<std::string, std::string>> ControlClient::set_parameters(const std::map<std::string, std::string>& values) {
  v1::ControlRequest request;
  request.mutable_set_parameters()->mutable_values()->insert(values.begin(), values.end());
  return link_->ask(std::move(request)).map([](const v1::ControlReply& reply) { return plain(reply.parameters()); });
}

}  // namespace gfp
