#pragma once

#include <string>
#include <vector>

#include "gfp/core/fields.hpp"

namespace gfp {

/// Where and how the daemon publishes (DESIGN, endpoints and topics).
struct PublishOptions {
  std::vector<std::string> sensor_endpoints;  ///< Empty: default_endpoint("sensor").
  std::vector<std::string> state_endpoints;   ///< Empty: default_endpoint("state").
  std::vector<std::string> control_endpoints; ///< Empty: default_endpoint("control").
  std::string curve_key;                      ///< The daemon's own key (`gfp key new`): tcp is then encrypted and authenticated.
  std::string authorized_keys;                ///< Folder with the .pub files of those who may connect over tcp.
  bool insecure = false;                      ///< Allows tcp without a key: neither encrypted nor authenticated.
  int max_connections = 256;                  ///< To all endpoints together; who comes beyond is sent away.
  int sensor_high_water_mark = 3;             ///< Messages that wait for one slow subscriber before the newest are dropped.
  int state_high_water_mark = 1000;
  double heartbeat_s = 1.0;                   ///< Status, topologies and last values are repeated this often.
  std::string remote_depth = "zstd";          ///< Coding of depth over tcp; raw costs three times the bytes. ipc is raw.
  std::string vertices = "float32";           ///< Coding of vertices on the wire; int16 halves them (0.5 * extent / 32767).
};

template <class Visitor>
void visit_fields(PublishOptions& o, Visitor&& field) {
  field("sensor_endpoints", o.sensor_endpoints);
  field("state_endpoints", o.state_endpoints);
  field("control_endpoints", o.control_endpoints);
  field("curve_key", o.curve_key);
  field("authorized_keys", o.authorized_keys);
  field("insecure", o.insecure);
  field("max_connections", o.max_connections, 8, 10'000);
  field("sensor_high_water_mark", o.sensor_high_water_mark, 1, 100);
  field("state_high_water_mark", o.state_high_water_mark, 10, 100'000);
  field("heartbeat_s", o.heartbeat_s, 0.05, 60.0);
  field("remote_depth", o.remote_depth, OneOf{{"zstd", "raw"}});
  field("vertices", o.vertices, OneOf{{"float32", "int16"}});
}

}  // namespace gfp
