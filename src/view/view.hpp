#pragma once

#include <functional>
#include <memory>

#include "gfp/core/error.hpp"
#include "gfp/frame/replay_control.hpp"
#include "publish/inbox.hpp"
#include "view/view_options.hpp"

namespace gfp {

/// What a person sees of the daemon: the Foxglove WebSocket protocol and a built-in page, on one port and one thread of its own.
///
///     Publisher --mirror()--> Inbox (latest value a kind) --view thread--> Hub --> each client's queue --> WebSocket
///
/// Encodes only what some client has subscribed to.
class View {
 public:
  /// Takes a client's request to the daemon, on the view's thread; the reply goes to the function beside it, from any thread.
  using Ask = std::function<void(PeerRequest, std::function<void(PeerReply)>)>;

  /// `playback`: the knobs of the one recording that is played, for clients to turn; empty: none. `ask`: may be empty, then no service is offered.
  /// Errors: kInvalidArgument (options), kIo (the port is taken, no such address).
  static Result<std::unique_ptr<View>> start(const ViewOptions& options, std::uint64_t session, std::shared_ptr<ReplayControl> playback = {}, Ask ask = {});
  ~View();  ///< As stop().

  void stop();  ///< Closes all connections and asks no more; the inbox stays.

  Inbox& inbox() { return inbox_; }  ///< Where values are put.

  /// The port it listens on.
  int port() const;

 private:
  class Server;
  View();

  Inbox inbox_;
  std::unique_ptr<Server> server_;
};

}  // namespace gfp
