#include "gfp/client/frame_assembler.hpp"

#include "gfp/v1/sensor.pb.h"
#include "wire/bounded_parse.hpp"
#include "wire/geometry_messages.hpp"
#include "wire/sensor_messages.hpp"

namespace gfp {
namespace {

/// The capture that a header speaks of; what was there of an older one is dropped.
Frame& capture(std::map<std::string, Frame>& waiting, const v1::FrameHeader& header) {
  Frame& frame = waiting[header.sensor()];
  if (frame.sequence != header.sequence() || frame.sensor.empty()) frame = {};
  frame.sensor = header.sensor();
  frame.sequence = header.sequence();
  frame.stamps = wire::stamps_from(header);
  return frame;
}

}  // namespace

Result<std::optional<Frame>> FrameAssembler::put(const Message& message) {
  constexpr std::size_t kMaxSensors = 64;
  if (waiting_.size() > kMaxSensors) return failure(ErrorCode::kTooLarge, "more than 64 sensors");
  const auto header_bytes = wire::as_bytes(message.payload), blob = wire::as_bytes(message.blob);
  if (message.schema == "gfp.v1.DepthImage") {
    v1::DepthImage header;
    if (auto parsed = wire::parse_bounded(header_bytes, wire::kMaxImageHeaderBytes, header); !parsed) return tl::unexpected(parsed.error());
    auto depth = wire::depth_from(header, blob);
    if (!depth) return tl::unexpected(depth.error());
    capture(waiting_, header.header()).depth = std::move(*depth);
  } else if (message.schema == "gfp.v1.ColorImage") {
    v1::ColorImage header;
    if (auto parsed = wire::parse_bounded(header_bytes, wire::kMaxImageHeaderBytes, header); !parsed) return tl::unexpected(parsed.error());
    auto color = wire::color_from(header, blob);
    if (!color) return tl::unexpected(color.error());
    capture(waiting_, header.header()).color = std::move(*color);
  } else if (message.schema == "gfp.v1.CameraInfo") {
    v1::CameraInfo info;
    if (auto parsed = wire::parse_bounded(header_bytes, wire::kMaxImageHeaderBytes, info); !parsed) return tl::unexpected(parsed.error());
    Frame& frame = capture(waiting_, info.header());
    if (frame.depth.pixels.empty()) return std::optional<Frame>();
    if (auto filled = wire::camera_into(info, frame); !filled) return tl::unexpected(filled.error());
    return std::exchange(frame, {});
  }
  return std::optional<Frame>();
}

}  // namespace gfp
