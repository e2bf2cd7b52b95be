#include "view/client.hpp"

#include <fmt/format.h>

#include <utility>

namespace gfp::view {

Result<void> Client::subscribe(std::uint32_t subscription, std::uint32_t channel) {
  if (channel_of_.size() >= kMaxSubscriptions) return failure(ErrorCode::kTooLarge, fmt::format("more than {} subscriptions", kMaxSubscriptions));
  if (channel_of_.contains(subscription)) return failure(ErrorCode::kInvalidArgument, fmt::format("subscription {} exists already", subscription));
  if (by_channel_.contains(channel)) return failure(ErrorCode::kInvalidArgument, fmt::format("channel {} is subscribed to already", channel));
  channel_of_[subscription] = channel;
  by_channel_[channel] = subscription;
  return {};
}

void Client::unsubscribe(std::uint32_t subscription) {
  const auto found = channel_of_.find(subscription);
  if (found == channel_of_.end()) return;
  queue_.forget(found->second);
  by_channel_.erase(found->second);
  channel_of_.erase(found);
}

void Client::send_control(Outgoing message) {
  if (controls_.size() >= kMaxControls) return;  // who does not read its answers gets no more of them
  controls_.push_back(std::move(message));
  wake_();
}

void Client::send_time(std::string message) {
  time_ = std::move(message);
  wake_();
}

void Client::send(ClientQueue::Class kind, std::uint32_t channel, const std::string& key, std::uint64_t log_time_ns, const Payload& payload, Nanoseconds now) {
  const auto found = by_channel_.find(channel);
  if (found == by_channel_.end()) return;
  const bool is_lost = queue_.put(kind, channel, key, {found->second, log_time_ns, payload});
  if (is_lost && (!warned_ || now - *warned_ >= kWarnEvery)) {
    warned_ = now;
    send_text(status(StatusLevel::kWarning, "Send buffer limit reached"));  // viewers know this very text
  }
  wake_();
}

std::optional<Client::Outgoing> Client::take() {
  if (!controls_.empty()) {
    Outgoing first = std::move(controls_.front());
    controls_.pop_front();
    return first;
  }
  if (time_) return Outgoing{false, *std::exchange(time_, std::nullopt), nullptr};
  auto message = queue_.take();
  if (!message) return std::nullopt;
  return Outgoing{false, message_header(message->subscription, message->log_time_ns), std::move(message->payload)};
}

}  // namespace gfp::view
