#pragma once

#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "gfp/core/time.hpp"
#include "view/client_queue.hpp"
#include "view/protocol.hpp"

namespace gfp::view {

/// One connected viewer: what it has subscribed to, and what waits to be sent to it. The view's thread only.
class Client {
 public:
  /// `wake` is called when there is something to send.
  Client(std::size_t max_queue_bytes, std::function<void()> wake) : queue_(max_queue_bytes), wake_(std::move(wake)) {}

  /// A frame to write: text, or a header with the payload behind it.
  struct Outgoing {
    bool is_text = false;
    std::string head;
    Payload payload;  ///< Of messages; else empty.
  };

  /// Errors: kTooLarge (too many), kInvalidArgument (an id that is in use).
  Result<void> subscribe(std::uint32_t subscription, std::uint32_t channel);
  void unsubscribe(std::uint32_t subscription);
  bool wants(std::uint32_t channel) const { return by_channel_.contains(channel); }

  void send_text(std::string text) { send_control({true, std::move(text), nullptr}); }
  void send_binary(std::string bytes) { send_control({false, std::move(bytes), nullptr}); }  ///< As a text: in order, none is left out.
  void send_time(std::string message);  ///< The newest only.

  /// Of a channel that it wants; says so, now and then, when something is lost for want of room.
  void send(ClientQueue::Class kind, std::uint32_t channel, const std::string& key, std::uint64_t log_time_ns, const Payload& payload, Nanoseconds now);

  std::optional<Outgoing> take();

  bool steers_playback = false;  ///< It has asked for something, so that it understands the answers.

 private:
  void send_control(Outgoing message);

  static constexpr std::size_t kMaxSubscriptions = 200;
  static constexpr std::size_t kMaxControls = 256;
  static constexpr Nanoseconds kWarnEvery{5'000'000'000};

  std::map<std::uint32_t, std::uint32_t> channel_of_;   ///< By subscription.
  std::map<std::uint32_t, std::uint32_t> by_channel_;   ///< Subscription by channel: one each.
  std::deque<Outgoing> controls_;
  std::optional<std::string> time_;
  ClientQueue queue_;
  std::optional<Nanoseconds> warned_;
  std::function<void()> wake_;
};

}  // namespace gfp::view
