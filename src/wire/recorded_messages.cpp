#include "wire/recorded_messages.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "gfp/v1/sensor.pb.h"
#include "wire/bounded_parse.hpp"
#include "wire/foxglove_messages.hpp"
#include "wire/geometry_messages.hpp"
#include "wire/mesh_messages.hpp"
#include "wire/scene_messages.hpp"
#include "wire/schema.hpp"
#include "wire/sensor_messages.hpp"
#include "wire/topics.hpp"

namespace gfp::wire {
namespace {

constexpr Nanoseconds kRepeat{1'000'000'000};
constexpr std::size_t kMaxImageBytes = (std::size_t{4} * kMaxImageSide * kMaxImageSide) + 4096;
constexpr std::size_t kMaxKnownTopologies = 4096;

Result<foxglove::RawImage> parse_image(std::string_view payload) {
  foxglove::RawImage message;
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxImageBytes, message); !parsed) return tl::unexpected(parsed.error());
  if (message.width() > kMaxImageSide || message.height() > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, fmt::format("image is {} x {}, expected at most {} a side", message.width(), message.height(), kMaxImageSide));
  return message;
}

/// The rows fit the bytes.
Result<void> check_rows(const foxglove::RawImage& message, std::size_t bytes_per_pixel) {
  const std::uint64_t width = message.width(), height = message.height(), step = message.step();
  if (step < width * bytes_per_pixel || step * height > message.data().size() || width == 0 || height == 0)
    return failure(ErrorCode::kCorruptData, fmt::format("image of {} x {} with rows of {} bytes has {} bytes", width, height, step, message.data().size()));
  return {};
}

}  // namespace

RecordingMessages::Channel& RecordingMessages::channel(const std::string& topic, std::string_view schema) {
  Channel& found = channels_[topic];
  if (found.spec.topic.empty()) found.spec = {topic, "protobuf", std::string(schema), "protobuf", {}, {}};
  return found;
}

bool RecordingMessages::is_due(const std::string& topic, Nanoseconds log_time, Nanoseconds period) {
  const auto [entry, is_new] = last_.try_emplace(topic, log_time);
  const bool is_due = is_new || log_time - entry->second >= period || log_time < entry->second;
  if (is_due) entry->second = log_time;
  return is_due;
}

template <class Message>
void RecordingMessages::send(const std::string& topic, const Message& message, Nanoseconds log_time, Nanoseconds publish_time, const Sink& sink) {
  const google::protobuf::Descriptor& descriptor = *message.GetDescriptor();
  Channel& to = channel(topic, descriptor.full_name());
  if (to.spec.schema_data.empty()) to.spec.schema_data = descriptor_set(descriptor);
  bytes_.clear();
  message.AppendToString(&bytes_);
  sink(to.spec, {0, to.next_sequence++, static_cast<std::uint64_t>(log_time.count()), static_cast<std::uint64_t>(publish_time.count()), bytes_});
}

void RecordingMessages::put(const Frame& frame, Nanoseconds log_time, const Sink& sink) {
  if (!content_.depth && !content_.color) return;
  const auto topic = [&](const char* stream) { return sensor_topic(frame.sensor, stream); };
  const Nanoseconds taken = frame.stamps.realtime;
  v1::FrameInfo info;
  fill_camera(frame, *info.mutable_camera());
  info.set_depth_scale_m(frame.depth.scale_m);
  send(topic("frame"), info, log_time, taken, sink);
  if (content_.depth) {
    foxglove::RawImage image;
    fill_depth_image(frame, image);
    const std::span<const std::byte> units = depth_blob(frame);
    if (frame.depth.scale_m != 0.001) image.set_data(units.data(), units.size());  // not a digit is lost; viewers then show units, not millimetres
    send(topic("depth"), image, log_time, taken, sink);
  }
  if (content_.color && !frame.color.empty()) {
    foxglove::RawImage image;
    fill_color_image(frame, image);
    send(topic("color"), image, log_time, taken, sink);
  }
  if (const std::string camera = topic("camera"); is_due(camera, log_time, kRepeat)) {
    foxglove::CameraCalibration calibration;
    fill_calibration(frame, calibration);
    send(camera, calibration, log_time, taken, sink);
  }
  if (is_due(frame.sensor + " tf", log_time, kRepeat)) {
    foxglove::FrameTransforms transforms;
    fill_transforms(frame, transforms);
    send(std::string(kTransformTopic), transforms, log_time, taken, sink);
  }
}

void RecordingMessages::put(const Scene& scene, Nanoseconds log_time, const Sink& sink) {
  if (!content_.objects) return;
  const Nanoseconds taken = scene.stamps.realtime;
  for (const SceneObject& object : scene.objects) {
    if (!object.model.topology || !is_due(mesh_topic(object.model.topology->hash), log_time, kRepeat)) continue;
    v1::Topology topology;
    fill(*object.model.topology, object.model.vertices.size(), topology);
    send(std::string(kRecordedMeshTopic), topology, log_time, taken, sink);
  }
  v1::Scene message;
  fill(scene, VertexCoding::kInt16, message);
  send(std::string(kSceneTopic), message, log_time, taken, sink);
  const auto period = Nanoseconds(std::llround(1e9 / std::max(content_.view_hz, 1e-3)));
  if (content_.view_hz <= 0 || (!is_due(scene.sensor + " view", log_time, period) && scene.lost.empty())) return;
  foxglove::SceneUpdate update;
  fill_scene_update(scene, update);
  send(std::string(kViewTopic), update, log_time, taken, sink);
}

Result<Frame> frame_from_info(std::string_view payload) {
  v1::FrameInfo message;
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxImageHeaderBytes, message); !parsed) return tl::unexpected(parsed.error());
  if (!(message.depth_scale_m() > 0 && message.depth_scale_m() <= 1))
    return failure(ErrorCode::kCorruptData, fmt::format("frame.depth_scale_m = {}, expected (0, 1]", message.depth_scale_m()));
  Frame frame;
  if (auto filled = camera_into(message.camera(), frame); !filled) return tl::unexpected(filled.error());
  frame.depth.scale_m = message.depth_scale_m();
  return frame;
}

Result<DepthImage> depth_from_raw_image(std::string_view payload, double scale_m) {
  const auto message = parse_image(payload);
  if (!message) return tl::unexpected(message.error());
  if (message->encoding() != "16UC1" && message->encoding() != "mono16")
    return failure(ErrorCode::kUnsupported, fmt::format("depth encoding {}, expected 16UC1 or mono16", message->encoding().substr(0, 32)));
  if (auto fits = check_rows(*message, 2); !fits) return tl::unexpected(fits.error());
  DepthImage depth{Image<std::uint16_t>(static_cast<int>(message->width()), static_cast<int>(message->height())), scale_m};
  const std::size_t row = 2 * static_cast<std::size_t>(message->width());
  for (std::size_t v = 0; v < message->height(); ++v) std::memcpy(&depth.pixels.pixels[v * message->width()], message->data().data() + v * message->step(), row);
  return depth;
}

Result<Image<Rgb8>> color_from_raw_image(std::string_view payload) {
  const auto message = parse_image(payload);
  if (!message) return tl::unexpected(message.error());
  const std::string& encoding = message->encoding();
  const bool is_bgr = encoding == "bgr8", is_grey = encoding == "mono8";
  if (encoding != "rgb8" && !is_bgr && !is_grey) return failure(ErrorCode::kUnsupported, fmt::format("colour encoding {}, expected rgb8, bgr8 or mono8", encoding.substr(0, 32)));
  if (auto fits = check_rows(*message, is_grey ? 1 : 3); !fits) return tl::unexpected(fits.error());
  Image<Rgb8> color(static_cast<int>(message->width()), static_cast<int>(message->height()));
  for (std::size_t v = 0; v < message->height(); ++v) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(message->data().data()) + v * message->step();
    for (std::size_t u = 0; u < message->width(); ++u) {
      const std::uint8_t* pixel = row + (is_grey ? u : 3 * u);
      color.pixels[v * message->width() + u] = is_grey ? Rgb8{pixel[0], pixel[0], pixel[0]} : is_bgr ? Rgb8{pixel[2], pixel[1], pixel[0]} : Rgb8{pixel[0], pixel[1], pixel[2]};
    }
  }
  return color;
}

Result<CameraModel> camera_from_calibration(std::string_view payload) {
  foxglove::CameraCalibration message;
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxImageHeaderBytes, message); !parsed) return tl::unexpected(parsed.error());
  if (message.k_size() != 9 || message.d_size() > 64)
    return failure(ErrorCode::kCorruptData, fmt::format("calibration.K has {} numbers, expected 9, and D {}", message.k_size(), message.d_size()));
  return camera_from_matrix(message.width(), message.height(), std::span<const double, 9>(message.k().data(), 9), message.distortion_model(), {message.d().begin(), message.d().end()});
}

Result<void> RecordedScenes::put_topology(std::string_view payload) {
  v1::Topology message;
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxTopologyBytes, message); !parsed) return parsed;
  if (topologies_.contains(message.hash())) return {};
  if (topologies_.size() >= kMaxKnownTopologies) return failure(ErrorCode::kTooLarge, fmt::format("more than {} topologies", kMaxKnownTopologies));
  auto topology = topology_from(message);
  if (!topology) return tl::unexpected(topology.error());
  topologies_[message.hash()] = std::make_shared<const Topology>(std::move(*topology));
  return {};
}

Result<Scene> RecordedScenes::scene(std::string_view payload) const {
  v1::Scene message;
  if (auto parsed = parse_bounded(as_bytes(payload), kMaxSceneBytes, message); !parsed) return tl::unexpected(parsed.error());
  return scene_from(message, [&](std::uint64_t hash) {
    const auto found = topologies_.find(hash);
    return found == topologies_.end() ? nullptr : found->second;
  });
}

}  // namespace gfp::wire
