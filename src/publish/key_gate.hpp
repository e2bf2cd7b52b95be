#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// Who may connect with CURVE: those whose public key is in a `.pub` file of a folder, as with authorized keys of ssh. The ZAP
/// handler (RFC 27) of one ZeroMQ context, on a thread of its own. The folder is read again at most a second later, so that a
/// file that is added or removed holds for every connection after that, and revoked() says when a key is gone that was let in.
class KeyGate {
 public:
  /// Must come before the context's other sockets. Errors: kNotFound (no such folder), kIo.
  static Result<std::unique_ptr<KeyGate>> open(zmq::context_t& context, std::filesystem::path folder);
  ~KeyGate();  ///< Shuts the context down: close the other sockets' work before.

  /// Whether, since the last call, a key was taken away that had been let in: its connections still stand. Safe from any thread.
  bool take_revoked() { return revoked_.exchange(false); }

  static constexpr const char* kDomain = "gfp";

 private:
  KeyGate(zmq::context_t& context, std::filesystem::path folder, zmq::socket_t socket);
  void run();
  bool is_authorized(const std::string& public_key);
  void read_keys();

  static constexpr Nanoseconds kReadAgain{1'000'000'000};
  static constexpr std::size_t kMaxKeys = 10'000;

  zmq::context_t& context_;
  const std::filesystem::path folder_;
  zmq::socket_t socket_;
  std::set<std::string> keys_, let_in_;  ///< Z85. The thread's own.
  Nanoseconds read_{-kReadAgain};
  std::atomic<bool> revoked_ = false;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
