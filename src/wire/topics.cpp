#include "wire/topics.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace gfp::wire {

std::string object_topic(std::uint64_t id) { return fmt::format("{}{}/", kObjectsPrefix, id); }
std::string mesh_topic(std::uint64_t topology_hash) { return fmt::format("{}{:016x}/", kMeshPrefix, topology_hash); }
std::string sensor_topic(std::string_view sensor, std::string_view stream) { return fmt::format("{}{}/{}/", kSensorPrefix, sensor, stream); }
std::string shadow_topic(std::string_view method) { return fmt::format("{}{}/", kShadowPrefix, method); }
std::string status_topic(std::string_view name) { return fmt::format("{}{}/", kStatusPrefix, name); }

std::string_view endpoint_of(std::string_view topic) { return topic.starts_with(kSensorPrefix) ? "sensor" : "state"; }

std::string default_endpoint(std::string_view name) {
  for (const char* variable : {"RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR"})
    if (const char* folder = std::getenv(variable); folder != nullptr && *folder != '\0') return fmt::format("ipc://{}/gfp/{}", folder, name);
  return fmt::format("ipc:///tmp/gfp-{}/gfp/{}", getuid(), name);
}

}  // namespace gfp::wire
