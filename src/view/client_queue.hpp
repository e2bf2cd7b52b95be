#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace gfp::view {

using Payload = std::shared_ptr<const std::string>;

/// What is to be sent to one client: the newest message a slot, small and rare things before images. One thread at a time.
///
/// A slot is a channel and, where a channel carries several things that do not replace each other (topologies, statuses), a key.
class ClientQueue {
 public:
  /// Of a channel: which slots go first, and which may be dropped for want of room.
  enum class Class : std::uint8_t { kState, kSensor };

  struct Message {
    std::uint32_t subscription = 0;
    std::uint64_t log_time_ns = 0;
    Payload payload;
  };

  explicit ClientQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Replaces what the slot still holds. Beyond `max_bytes` sensor data makes room, and where that is not enough, the new message is
  /// dropped. Returns whether anything was lost that way (not by being replaced).
  bool put(Class kind, std::uint32_t channel, const std::string& key, Message message);

  std::optional<Message> take();  ///< State first, each kind in the order in which its slots were filled.
  void forget(std::uint32_t channel);

  std::size_t bytes() const { return bytes_; }
  std::uint64_t replaced() const { return replaced_; }

 private:
  struct Slot {
    std::uint32_t channel = 0;
    std::string key;
    auto operator<=>(const Slot&) const = default;
  };
  struct Order {
    Class kind = Class::kState;
    std::uint64_t turn = 0;
    auto operator<=>(const Order&) const = default;
  };
  struct Waiting {
    Slot slot;
    Message message;
  };
  using Queue = std::map<Order, Waiting>;

  void erase(Queue::iterator place);

  const std::size_t max_bytes_;
  std::map<Slot, Order> places_;
  Queue waiting_;
  std::uint64_t next_turn_ = 0;
  std::size_t bytes_ = 0;
  std::uint64_t replaced_ = 0;
};

}  // namespace gfp::view
