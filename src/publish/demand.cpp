#include "publish/demand.hpp"

#include <algorithm>

namespace gfp {

std::string Demand::update(std::span<const std::byte> message) {
  if (message.empty()) return {};
  std::string prefix(reinterpret_cast<const char*>(message.data()) + 1, message.size() - 1);
  if (message[0] == std::byte{0}) {
    prefixes_.erase(prefix);
    return {};
  }
  if (message[0] != std::byte{1}) return {};
  if (prefixes_.size() < kMaxPrefixes) prefixes_.insert(prefix);
  else overflowed_ = true;
  return prefix.empty() ? "/" : prefix;
}

bool Demand::wants(std::string_view topic) const {
  if (overflowed_) return true;
  // Each prefix of the topic is looked up: topics are short, subscriptions may be many.
  for (std::size_t length = 0; length <= topic.size(); ++length)
    if (prefixes_.find(topic.substr(0, length)) != prefixes_.end()) return true;
  return false;
}

bool Demand::wants_below(std::string_view prefix) const {
  if (wants(prefix)) return true;
  const auto next = prefixes_.lower_bound(prefix);
  return next != prefixes_.end() && next->starts_with(prefix);
}

}  // namespace gfp
