#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gfp::wire {

/// Names of topics (DESIGN): ROS-style, ending in `/`, so that a ZeroMQ prefix never matches half a name.
inline constexpr std::string_view kSceneTopic = "/gfp/scene/";
inline constexpr std::string_view kLogTopic = "/gfp/log/";
inline constexpr std::string_view kObjectsPrefix = "/gfp/objects/";
inline constexpr std::string_view kMeshPrefix = "/gfp/mesh/";
inline constexpr std::string_view kSensorPrefix = "/gfp/sensor/";
inline constexpr std::string_view kShadowPrefix = "/gfp/shadow/";
inline constexpr std::string_view kStatusPrefix = "/gfp/status/";

std::string object_topic(std::uint64_t id);
std::string mesh_topic(std::uint64_t topology_hash);  ///< Hash as 16 hexadecimal digits.
std::string sensor_topic(std::string_view sensor, std::string_view stream);  ///< depth, color or camera.
std::string shadow_topic(std::string_view method);
std::string status_topic(std::string_view name);

/// `sensor` for topics under /gfp/sensor/, `state` for all others: which endpoint carries a topic (or a prefix of one).
std::string_view endpoint_of(std::string_view topic);

/// Where the daemon and its clients meet without any configuration:
/// `ipc://<folder>/gfp/<name>` with the folder RUNTIME_DIRECTORY, else XDG_RUNTIME_DIR, else `/tmp/gfp-<uid>`.
std::string default_endpoint(std::string_view name);

}  // namespace gfp::wire
