#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <stop_token>
#include <thread>

#include "gfp/core/mutex.hpp"
#include "publish/control_socket.hpp"

namespace gfp {

/// Where control requests wait that take time: one thread answers them one after the other, so that neither the publisher nor the
/// pipeline waits for them. At most kMaxWaiting wait; a request beyond is answered with CODE_BUSY.
class ControlDesk {
 public:
  using Answer = std::function<v1::ControlReply(const v1::ControlRequest&)>;
  using Send = std::function<void(PeerReply)>;

  explicit ControlDesk(Answer answer) : answer_(std::move(answer)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

  /// The answer goes to `send`, on the desk's thread or at once. Safe from any thread, never blocks.
  void put(PeerRequest request, Send send);

 private:
  struct Waiting {
    PeerRequest request;
    Send send;
  };
  void run(const std::stop_token& stop);

  static constexpr std::size_t kMaxWaiting = 16;

  const Answer answer_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Waiting> waiting_ GFP_GUARDED_BY(mutex_);
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
