#include "view/view.hpp"

#include <utility>  // before asio: its 1.74 forgets it

#include <boost/asio.hpp>
#include <boost/beast.hpp>

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <set>
#include <thread>

#include "gfp/core/version.hpp"
#include "view/access.hpp"
#include "view/hub.hpp"
#include "view/page.hpp"

namespace gfp {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using view::Client;
using view::Hub;

constexpr std::chrono::seconds kHttpTimeout{10};
constexpr std::chrono::seconds kSilence{20};  ///< A viewer that says nothing for so long, and does not answer a ping, is gone.
constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr int kMaxRequests = 64;  ///< At a time; a connection beyond is closed.

/// What connections share; lives as long as the server's thread.
struct Shared {
  const ViewOptions options;
  Hub hub;
  std::set<class Socket*> sockets;
  int requests = 0;  ///< At work.
};

view::Caller caller_of(const http::request<http::empty_body>& request) {
  const auto text = [](auto value) { return std::string_view(value.data(), value.size()); };
  return {text(request.target()), text(request[http::field::host]), text(request[http::field::origin]), text(request[http::field::authorization]), text(request[http::field::cookie])};
}

/// One viewer's WebSocket: reads its texts, writes what its Client has.
class Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(beast::tcp_stream stream, Shared& shared)
      : shared_(shared), socket_(std::move(stream)), client_(static_cast<std::size_t>(shared.options.max_queue_mb) << 20U, [this] { write(); }) {}
  ~Socket() {
    shared_.hub.leave(client_);
    shared_.sockets.erase(this);
  }

  void accept(const http::request<http::empty_body>& request, std::string_view subprotocol) {
    shared_.sockets.insert(this);
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kHttpTimeout, kSilence, true});
    socket_.set_option(websocket::stream_base::decorator([protocol = std::string(subprotocol)](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, protocol);
      response.set(http::field::server, "gfpd");
    }));
    socket_.read_message_max(view::kMaxClientMessageBytes);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->is_open_ = true;
      self->shared_.hub.join(self->client_);
      self->read();
    });
  }

  void close() {
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

 private:
  void read() {
    socket_.async_read(received_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->leave();
      const std::string message = beast::buffers_to_string(self->received_.data());
      if (self->socket_.got_text()) self->shared_.hub.heard(self->client_, message);
      else self->shared_.hub.heard_binary(self->client_, message);
      self->received_.consume(self->received_.size());
      self->read();
    });
  }

  void write() {
    if (is_writing_ || !is_open_) return;
    auto next = client_.take();
    if (!next) return;
    is_writing_ = true;
    outgoing_ = std::move(*next);
    socket_.text(outgoing_.is_text);
    const std::array<asio::const_buffer, 2> parts{asio::buffer(outgoing_.head), outgoing_.payload ? asio::buffer(*outgoing_.payload) : asio::const_buffer()};
    socket_.async_write(parts, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_writing_ = false;
      if (error) return self->leave();
      self->write();
    });
  }

  void leave() {
    is_open_ = false;
    shared_.hub.leave(client_);
    close();
  }

  Shared& shared_;
  websocket::stream<beast::tcp_stream> socket_;
  Client client_;
  beast::flat_buffer received_{view::kMaxClientMessageBytes};
  Client::Outgoing outgoing_;
  bool is_open_ = false, is_writing_ = false;
};

/// One HTTP request: the page, or the way to a WebSocket.
class Request : public std::enable_shared_from_this<Request> {
 public:
  Request(tcp::socket socket, Shared& shared) : shared_(shared), stream_(std::move(socket)) {
    parser_.header_limit(kMaxHeaderBytes);
    parser_.body_limit(0);
    ++shared_.requests;
  }
  ~Request() { --shared_.requests; }

  void read() {
    stream_.expires_after(kHttpTimeout);
    http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->answer();
    });
  }

 private:
  void answer() {
    const http::request<http::empty_body>& request = parser_.get();
    const view::Caller caller = caller_of(request);
    if (!view::is_our_host(caller, shared_.options)) return reply(http::status::forbidden, "this host name is not ours\n");
    if (!view::has_token(caller, shared_.options)) return reply(http::status::unauthorized, "a token is needed: /?token=...\n");
    if (websocket::is_upgrade(request)) return upgrade(request, caller);
    if (request.method() != http::verb::get && request.method() != http::verb::head) return reply(http::status::method_not_allowed, "GET is all there is\n");
    const std::string_view path = caller.target.substr(0, caller.target.find('?'));
    if (path == "/" || path == "/index.html") return send_page();
    reply(http::status::not_found, "there is one page: /\n");
  }

  void upgrade(const http::request<http::empty_body>& request, const view::Caller& caller) {
    const auto offered = request[http::field::sec_websocket_protocol];
    const std::string_view subprotocol = view::choose_subprotocol({offered.data(), offered.size()});
    if (!view::is_welcome_origin(caller, shared_.options)) return reply(http::status::forbidden, "this page's origin is not in view.allowed_origins\n");
    if (subprotocol.empty()) return reply(http::status::bad_request, "expected the subprotocol foxglove.sdk.v1 or foxglove.websocket.v1\n");
    if (shared_.sockets.size() >= static_cast<std::size_t>(shared_.options.max_clients)) return reply(http::status::service_unavailable, "view.max_clients are connected\n");
    std::make_shared<Socket>(std::move(stream_), shared_)->accept(request, subprotocol);
  }

  void send_page() {
    response_.result(http::status::ok);
    response_.set(http::field::content_type, "text/html; charset=utf-8");
    if (view::page_is_compressed()) response_.set(http::field::content_encoding, "gzip");
    // All of the page is in the page; it talks to this host and to nobody else.
    response_.set("Content-Security-Policy", "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'");
    response_.set("X-Content-Type-Options", "nosniff");
    if (!shared_.options.token.empty())
      response_.set(http::field::set_cookie, fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", view::kCookieName, shared_.options.token));
    response_.body() = view::page();
    send();
  }

  void reply(http::status code, std::string text) {
    response_.result(code);
    response_.set(http::field::content_type, "text/plain; charset=utf-8");
    response_.body() = std::move(text);
    send();
  }

  void send() {
    response_.version(11);
    response_.set(http::field::server, "gfpd");
    response_.set(http::field::cache_control, "no-store");
    response_.keep_alive(false);
    response_.prepare_payload();
    if (parser_.get().method() == http::verb::head) response_.body().clear();
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Shared& shared_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMaxHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

class View::Server {
 public:
  Server(const ViewOptions& options, std::uint64_t session, Inbox& inbox, std::shared_ptr<ReplayControl> playback, Hub::Ask ask)
      : shared_{options, Hub(fmt::format("gfpd {}", version()), session, std::move(playback), std::move(ask)), {}, 0}, inbox_(inbox), wake_(context_, dup(inbox.wake_file())), acceptor_(context_), pause_(context_) {}
  ~Server() {
    asio::post(context_, [this] {
      for (Socket* socket : shared_.sockets) socket->close();
      context_.stop();
    });
    if (thread_.joinable()) thread_.join();
  }

  Result<void> listen() {
    const std::string where = fmt::format("view: {}:{}", shared_.options.address, shared_.options.port);
    try {
      const tcp::endpoint endpoint(asio::ip::make_address(shared_.options.address == "localhost" ? "127.0.0.1" : shared_.options.address), static_cast<std::uint16_t>(shared_.options.port));
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      return failure(ErrorCode::kIo, fmt::format("{}: {}", where, error.code().message()));
    }
    accept();
    wait();
    thread_ = std::jthread([this] { run(); });
    return {};
  }

  int port() const { return acceptor_.local_endpoint().port(); }

 private:
  /// What goes wrong in one handler (memory, a bug) costs its message, not the daemon.
  void run() {
    pthread_setname_np(pthread_self(), "gfp-view");  // for top -H, and for who measures it
    while (!context_.stopped()) {
      try {
        context_.run();
      } catch (const std::exception&) {
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      if (!error && shared_.requests < kMaxRequests) std::make_shared<Request>(std::move(socket), shared_)->read();
      if (!error) return accept();
      pause_.expires_after(std::chrono::milliseconds(100));  // out of files, say: not again at once
      pause_.async_wait([this](error_code stopped) {
        if (!stopped) accept();
      });
    });
  }

  void wait() {
    wake_.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code error) {
      if (error) return;
      wait();
      shared_.hub.take(inbox_.take());
    });
  }

  Shared shared_;  ///< Before the context, which holds the connections that use it.
  asio::io_context context_{1};
  Inbox& inbox_;
  asio::posix::stream_descriptor wake_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::jthread thread_;
};

View::View() = default;
View::~View() = default;

Result<std::unique_ptr<View>> View::start(const ViewOptions& options, std::uint64_t session, std::shared_ptr<ReplayControl> playback, Ask ask) {
  if (auto valid = view::validate(options); !valid) return tl::unexpected(valid.error());
  std::unique_ptr<View> made(new View());
  Hub::Ask to_daemon;
  if (ask) to_daemon = [ask = std::move(ask), &inbox = made->inbox_](PeerRequest request) { ask(std::move(request), [&inbox](PeerReply reply) { inbox.put(std::move(reply)); }); };
  made->server_ = std::make_unique<Server>(options, session, made->inbox_, std::move(playback), std::move(to_daemon));
  if (auto listening = made->server_->listen(); !listening) return tl::unexpected(listening.error());
  return made;
}

void View::stop() { server_.reset(); }

int View::port() const { return server_->port(); }

}  // namespace gfp
