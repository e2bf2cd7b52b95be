#include "publish/key_gate.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "gfp/client/curve_key.hpp"

namespace gfp {
namespace {

constexpr std::size_t kKeyBytes = 32;

/// RFC 27: version, request id, domain, address, identity, mechanism, credentials...
enum RequestPart : std::size_t { kVersion, kRequestId, kDomainPart, kAddress, kIdentity, kMechanism, kCredentials, kRequestParts };

/// Empty: none came within the socket's timeout.
std::vector<std::string> receive_parts(zmq::socket_t& socket) {
  std::vector<std::string> parts;
  bool more = true;
  while (more) {
    zmq::message_t part;
    if (!socket.recv(part)) return {};
    more = part.more();
    if (parts.size() < kRequestParts) parts.emplace_back(part.data<char>(), part.size());
  }
  return parts;
}

std::string z85(const std::string& key) {
  std::array<char, 41> text{};
  zmq_z85_encode(text.data(), reinterpret_cast<const std::uint8_t*>(key.data()), kKeyBytes);
  return text.data();
}

}  // namespace

Result<std::unique_ptr<KeyGate>> KeyGate::open(zmq::context_t& context, std::filesystem::path folder) {
  std::error_code status;
  if (!std::filesystem::is_directory(folder, status)) return failure(ErrorCode::kNotFound, fmt::format("publish.authorized_keys = {}: no such folder", folder.string()));
  try {
    zmq::socket_t socket(context, zmq::socket_type::rep);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::rcvtimeo, static_cast<int>(kReadAgain.count() / 1'000'000));
    socket.bind("inproc://zeromq.zap.01");
    return std::unique_ptr<KeyGate>(new KeyGate(context, std::move(folder), std::move(socket)));
  } catch (const zmq::error_t& error) {
    return failure(ErrorCode::kIo, fmt::format("ZAP: {}", error.what()));
  }
}

KeyGate::KeyGate(zmq::context_t& context, std::filesystem::path folder, zmq::socket_t socket)
    : context_(context), folder_(std::move(folder)), socket_(std::move(socket)), thread_([this] { run(); }) {}

KeyGate::~KeyGate() {
  context_.shutdown();  // what ends run()
  thread_.join();
}

void KeyGate::run() {
  try {
    while (true) {
      const std::vector<std::string> parts = receive_parts(socket_);
      read_keys();
      if (parts.empty()) continue;
      const bool is_curve = parts.size() == kRequestParts && parts[kVersion] == "1.0" && parts[kDomainPart] == kDomain && parts[kMechanism] == "CURVE" &&
                            parts[kCredentials].size() == kKeyBytes;
      const bool is_welcome = is_curve && is_authorized(z85(parts[kCredentials]));
      if (is_welcome) let_in_.insert(z85(parts[kCredentials]));
      const std::string request_id = parts.size() > kRequestId ? parts[kRequestId] : "";
      // 300, not 400: a client whose key is not known yet goes on knocking (once a second), and is let in when it is.
      const std::array<std::string, 6> reply{"1.0", request_id, is_welcome ? "200" : "300", is_welcome ? "OK" : "this key is not authorized", "", ""};
      for (std::size_t i = 0; i < reply.size(); ++i)
        socket_.send(zmq::buffer(reply[i]), i + 1 < reply.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
    }
  } catch (const zmq::error_t&) {  // ETERM: the context was shut down
    socket_.close();
  }
}

bool KeyGate::is_authorized(const std::string& public_key) { return keys_.contains(public_key); }

/// Once a second at most.
void KeyGate::read_keys() {
  const Nanoseconds now = monotonic_now();
  if (now - read_ < kReadAgain) return;
  read_ = now;
  keys_.clear();
  std::error_code status;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, status)) {
    if (entry.path().extension() != ".pub" || keys_.size() >= kMaxKeys) continue;
    if (const auto key = read_curve_key(entry.path())) keys_.insert(key->public_key);
  }
  if (std::erase_if(let_in_, [&](const std::string& key) { return !keys_.contains(key); }) > 0) revoked_ = true;
}

}  // namespace gfp
