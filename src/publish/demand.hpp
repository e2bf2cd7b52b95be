#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace gfp {

/// What subscribers of one XPUB socket have asked for. One thread at a time.
class Demand {
 public:
  /// Takes in one message of the socket: a byte 1 (subscribe) or 0 (unsubscribe), then the prefix. Returns the prefix where
  /// somebody subscribed; empty otherwise. Beyond kMaxPrefixes nothing new is remembered: such a topic counts as wanted.
  std::string update(std::span<const std::byte> message);

  bool wants(std::string_view topic) const;  ///< A subscribed prefix matches the topic.
  bool wants_below(std::string_view prefix) const;  ///< Some topic that starts with `prefix` may be wanted.
  std::size_t size() const { return prefixes_.size(); }

 private:
  static constexpr std::size_t kMaxPrefixes = 10'000;
  std::set<std::string, std::less<>> prefixes_;
  bool overflowed_ = false;
};

}  // namespace gfp
