#include "daemon/control_desk.hpp"

#include <fmt/format.h>

#include <exception>
#include <optional>

namespace gfp {

void ControlDesk::put(PeerRequest request) {
  std::optional<PeerRequest> refused;
  {
    MutexLock lock(mutex_);
    if (waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(request));
    else refused = std::move(request);
    changed_.notify_all();
  }
  if (refused) send_({refused->peer, refusal(refused->request, v1::ControlReply::CODE_BUSY, fmt::format("{} requests wait already", kMaxWaiting))});
}

void ControlDesk::run(const std::stop_token& stop) {
  while (true) {
    PeerRequest request;
    {
      MutexLock lock(mutex_);
      changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return !waiting_.empty(); });
      if (stop.stop_requested()) return;
      request = std::move(waiting_.front());
      waiting_.pop_front();
    }
    v1::ControlReply reply;
    try {
      reply = answer_(request.request);
    } catch (const std::exception& error) {  // memory exhausted, or a bug: it costs this request
      reply = refusal(request.request, v1::ControlReply::CODE_UNAVAILABLE, error.what());
    }
    reply.set_id(request.request.id());
    send_({std::move(request.peer), std::move(reply)});
  }
}

}  // namespace gfp
