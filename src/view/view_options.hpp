#pragma once

#include <string>
#include <vector>

#include "gfp/core/fields.hpp"

namespace gfp {

/// The view: the Foxglove WebSocket protocol and a built-in page on one port.
struct ViewOptions {
  bool enabled = true;
  std::string address = "127.0.0.1";  ///< Beyond loopback a token is needed.
  int port = 8765;
  std::string token;                  ///< At least 16 characters; empty: none. Sent as `?token=`, as a bearer, or as the page's cookie.
  std::vector<std::string> allowed_origins{"https://app.foxglove.dev"};  ///< Pages of other hosts that may connect.
  int max_clients = 16;
  int max_queue_mb = 16;              ///< Bytes that wait for one slow client; beyond, the newest sensor data is dropped.
};

template <class Visitor>
void visit_fields(ViewOptions& o, Visitor&& field) {
  field("enabled", o.enabled);
  field("address", o.address);
  field("port", o.port, 1, 65'535);
  field("token", o.token);
  field("allowed_origins", o.allowed_origins);
  field("max_clients", o.max_clients, 1, 1000);
  field("max_queue_mb", o.max_queue_mb, 1, 1024);
}

}  // namespace gfp
