#include "view/client_queue.hpp"

namespace gfp::view {

bool ClientQueue::put(Class kind, std::uint32_t channel, const std::string& key, Message message) {
  const Slot slot{channel, key};
  Order order{kind, next_turn_++};
  if (const auto place = places_.find(slot); place != places_.end()) {
    order = place->second;  // it keeps its turn, else a fast channel would never come
    ++replaced_;
    erase(waiting_.find(order));
  }
  bool is_lost = false;
  while (bytes_ + message.payload->size() > max_bytes_ && !waiting_.empty() && waiting_.rbegin()->first.kind == Class::kSensor) {
    is_lost = true;
    erase(std::prev(waiting_.end()));
  }
  if (bytes_ + message.payload->size() > max_bytes_) return true;
  bytes_ += message.payload->size();
  places_.emplace(slot, order);
  waiting_.emplace(order, Waiting{slot, std::move(message)});
  return is_lost;
}

std::optional<ClientQueue::Message> ClientQueue::take() {
  if (waiting_.empty()) return std::nullopt;
  Message message = std::move(waiting_.begin()->second.message);
  bytes_ -= message.payload->size();
  places_.erase(waiting_.begin()->second.slot);
  waiting_.erase(waiting_.begin());
  return message;
}

void ClientQueue::forget(std::uint32_t channel) {
  for (auto place = waiting_.begin(); place != waiting_.end();) {
    const auto next = std::next(place);
    if (place->second.slot.channel == channel) erase(place);
    place = next;
  }
}

void ClientQueue::erase(Queue::iterator place) {
  bytes_ -= place->second.message.payload->size();
  places_.erase(place->second.slot);
  waiting_.erase(place);
}

}  // namespace gfp::view
