#include "publish/control_socket.hpp"

#include "wire/bounded_parse.hpp"
#include "wire/schema.hpp"

namespace gfp {

void ControlSocket::read(const std::function<void(PeerRequest)>& take) {
  for (int i = 0; i < kAtOnce; ++i) {
    zmq::message_t identity;
    if (!socket_.socket.recv(identity, zmq::recv_flags::dontwait)) return;
    ControlPeer peer{identity.to_string(), false};
    std::string body;
    int parts = 0;
    for (bool more = identity.more(); more; ++parts) {
      zmq::message_t part;
      if (!socket_.socket.recv(part, zmq::recv_flags::dontwait)) break;
      more = part.more();
      if (parts == 0 && more && part.size() == 0) peer.has_delimiter = true;
      else body = part.to_string();
    }
    answer(body, std::move(peer), take);
  }
}

void ControlSocket::answer(const std::string& body, ControlPeer peer, const std::function<void(PeerRequest)>& take) {
  if (body == "desc") return send(peer, wire::all_descriptors());
  PeerRequest request{std::move(peer), {}};
  const auto parsed = wire::parse_bounded(wire::as_bytes(body), kMaxRequestBytes, request.request);
  if (!parsed) return send({request.peer, refusal({}, v1::ControlReply::CODE_INVALID, parsed.error().what)});
  if (request.request.request_case() == v1::ControlRequest::REQUEST_NOT_SET)
    return send({request.peer, refusal(request.request, v1::ControlReply::CODE_INVALID, "a request of no known kind")});
  take(std::move(request));
}

void ControlSocket::send(const PeerReply& reply) { send(reply.peer, reply.reply.SerializeAsString()); }

void ControlSocket::send(const ControlPeer& peer, const std::string& body) {
  try {
    if (!socket_.socket.send(zmq::buffer(peer.identity), zmq::send_flags::sndmore | zmq::send_flags::dontwait)) return;
    if (peer.has_delimiter) socket_.socket.send(zmq::message_t(), zmq::send_flags::sndmore | zmq::send_flags::dontwait);
    socket_.socket.send(zmq::buffer(body), zmq::send_flags::dontwait);
  } catch (const zmq::error_t&) {  // EHOSTUNREACH: the peer is gone, and with it whoever wanted the reply
  }
}

v1::ControlReply refusal(const v1::ControlRequest& request, v1::ControlReply::Code code, std::string why) {
  v1::ControlReply reply;
  reply.set_id(request.id());
  reply.set_code(code);
  reply.set_error(std::move(why));
  return reply;
}

}  // namespace gfp
