#include "daemon/control_desk.hpp"

#include <fmt/format.h>

#include <exception>
#include <optional>

namespace gfp {

void ControlDesk::put(PeerRequest request, Send send) {
  std::optional<Waiting> refused;
  {
    MutexLock lock(mutex_);
    if (waiting_.size() < kMaxWaiting) waiting_.push_back({std::move(request), std::move(send)});
    else refused = Waiting{std::move(request), std::move(send)};
    changed_.notify_all();
  }
  if (refused) refused->send({refused->request.peer, refusal(refused->request.request, v1::ControlReply::CODE_BUSY, fmt::format("{} requests wait already", kMaxWaiting))});
}

void ControlDesk::run(const std::stop_token& stop) {
  while (true) {
    Waiting next;
    {
      MutexLock lock(mutex_);
      changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return !waiting_.empty(); });
      if (stop.stop_requested()) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
    }
    v1::ControlReply reply;
    try {
      reply = answer_(next.request.request);
    } catch (const std::exception& error) {  // memory exhausted, or a bug: it costs this request
      reply = refusal(next.request.request, v1::ControlReply::CODE_UNAVAILABLE, error.what());
    }
    reply.set_id(next.request.request.id());
    next.send({std::move(next.request.peer), std::move(reply)});
  }
}

}  // namespace gfp
