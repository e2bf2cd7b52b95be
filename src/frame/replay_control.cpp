#include "gfp/frame/replay_control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gfp {

void ReplayControl::pause() {
  MutexLock lock(mutex_);
  is_paused_ = true;
  for (auto& [id, player] : players_) player.steps = 0;
}

void ReplayControl::resume() {
  MutexLock lock(mutex_);
  is_paused_ = false;
  changed_.notify_all();
}

void ReplayControl::step() {
  MutexLock lock(mutex_);
  for (auto& [id, player] : players_) ++player.steps;
  changed_.notify_all();
}

void ReplayControl::set_speed(double speed) {
  MutexLock lock(mutex_);
  if (std::isfinite(speed)) speed_ = std::max(0.0, speed);
}

void ReplayControl::seek(Nanoseconds position) {
  MutexLock lock(mutex_);
  const Span span = span_locked();
  seek_.target = std::clamp(span.begin + position, span.begin, span.end);
  seek_.offset += position_locked() + kAfterJump - seek_.target;
  for (auto& [id, player] : players_) {
    player.position = seek_.target;
    player.is_to_seek = true;
    player.ended = false;
    if (is_paused_) ++player.steps;  // a person who seeks wants to see where
  }
  changed_.notify_all();
}

ReplayControl::State ReplayControl::state() const {
  MutexLock lock(mutex_);
  const Span span = span_locked();
  const bool ended = !players_.empty() && std::all_of(players_.begin(), players_.end(), [](const auto& entry) { return entry.second.ended; });
  return {is_paused_, speed_, span.begin, position_locked() - span.begin, span.end - span.begin, frames_, ended};
}

void ReplayControl::hold_at_end() {
  MutexLock lock(mutex_);
  holds_at_end_ = true;
}

bool ReplayControl::holds_at_end() const {
  MutexLock lock(mutex_);
  return holds_at_end_;
}

ReplayControl::Player ReplayControl::join(Nanoseconds first, Nanoseconds last, double speed) {
  MutexLock lock(mutex_);
  if (players_.empty()) speed_ = speed;
  Playing player;
  player.first = first, player.last = last;
  players_[next_player_] = player;
  return next_player_++;
}

void ReplayControl::leave(Player player) {
  MutexLock lock(mutex_);
  players_.erase(player);
}

ReplayControl::Span ReplayControl::span() const {
  MutexLock lock(mutex_);
  return span_locked();
}

ReplayControl::Span ReplayControl::span_locked() const {
  if (players_.empty()) return {};
  Span span{Nanoseconds::max(), Nanoseconds::min()};
  for (const auto& [id, player] : players_) span = {std::min(span.begin, player.first), std::max(span.end, player.last)};
  return span;
}

/// Of whoever has come furthest; at the beginning, the beginning.
Nanoseconds ReplayControl::position_locked() const {
  Nanoseconds furthest = span_locked().begin;
  for (const auto& [id, player] : players_)
    if (player.position) furthest = std::max(furthest, *player.position);
  return furthest;
}

void ReplayControl::played(Player player, Nanoseconds recorded_at, bool ended) {
  MutexLock lock(mutex_);
  Playing& playing = players_.at(player);
  playing.position = recorded_at;
  playing.ended = ended;
  if (!ended) ++frames_;
}

std::optional<ReplayControl::Seek> ReplayControl::take_seek(Player player) {
  MutexLock lock(mutex_);
  return std::exchange(players_.at(player).is_to_seek, false) ? std::optional(seek_) : std::nullopt;
}

bool ReplayControl::wait_until_running(Player player, std::chrono::milliseconds timeout) {
  MutexLock lock(mutex_);
  Playing& playing = players_.at(player);
  const auto may_run = [this, &playing]() GFP_REQUIRES(mutex_) { return !is_paused_ || playing.steps > 0; };
  if (!changed_.wait_for(lock, timeout, may_run)) return false;
  if (is_paused_) --playing.steps;
  return true;
}

bool ReplayControl::wait_for_seek(Player player, std::chrono::milliseconds timeout) {
  MutexLock lock(mutex_);
  Playing& playing = players_.at(player);
  return changed_.wait_for(lock, timeout, [&playing]() { return playing.is_to_seek; });
}

}  // namespace gfp
