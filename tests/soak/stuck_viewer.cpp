#include "soak/stuck_viewer.hpp"

#include <utility>  // before asio: its 1.74 forgets it

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <nlohmann/json.hpp>

namespace gfp::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Json = nlohmann::json;

struct StuckViewer::Connection {
  asio::io_context context;
  websocket::stream<asio::ip::tcp::socket> socket{context};
};

StuckViewer::StuckViewer(int port) : connection_(std::make_unique<Connection>()) {
  auto& socket = connection_->socket;
  socket.next_layer().connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)});
  socket.set_option(websocket::stream_base::decorator([](websocket::request_type& request) { request.set(beast::http::field::sec_websocket_protocol, "foxglove.sdk.v1"); }));
  socket.handshake("127.0.0.1:" + std::to_string(port), "/");
  Json subscriptions = Json::array();
  while (subscriptions.empty()) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const Json message = Json::parse(beast::buffers_to_string(buffer.data()), nullptr, false);
    if (message.is_discarded() || message.value("op", "") != "advertise") continue;
    for (const Json& channel : message["channels"]) subscriptions.push_back({{"id", channel["id"]}, {"channelId", channel["id"]}});
  }
  socket.write(asio::buffer(Json{{"op", "subscribe"}, {"subscriptions", subscriptions}}.dump()));
}

StuckViewer::~StuckViewer() = default;

}  // namespace gfp::test
