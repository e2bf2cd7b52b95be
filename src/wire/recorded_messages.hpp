#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/recording/mcap_encoder.hpp"
#include "gfp/recording/record_content.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp::wire {

/// Topics of a recording, beside those of the wire (topics.hpp): `/gfp/sensor/<name>/frame/`, and for viewers the objects and tf.
inline constexpr std::string_view kViewTopic = "/gfp/view/objects/";
inline constexpr std::string_view kTransformTopic = "/gfp/view/tf/";
inline constexpr std::string_view kRecordedMeshTopic = "/gfp/mesh/";  ///< All topologies on one topic.
inline constexpr std::string_view kFrameSchema = "gfp.v1.FrameInfo", kSceneSchema = "gfp.v1.Scene", kTopologySchema = "gfp.v1.Topology";

/// Turns frames and scenes into the messages of a recording. Every message carries what is needed to place it; topologies, tf and
/// calibrations come again every second, so that any second of a recording stands for itself. Knows no clock. One thread at a time.
///
///     /gfp/sensor/<name>/frame/   gfp.v1.FrameInfo              stamps, camera, pose, noise: with the images a frame bit by bit
///     /gfp/sensor/<name>/depth/   foxglove.RawImage             16UC1
///     /gfp/sensor/<name>/color/   foxglove.RawImage             rgb8
///     /gfp/sensor/<name>/camera/  foxglove.CameraCalibration
///     /gfp/scene/                 gfp.v1.Scene                  every scene
///     /gfp/mesh/                  gfp.v1.Topology
///     /gfp/view/objects/          foxglove.SceneUpdate          `view_hz` times a second
///     /gfp/view/tf/               foxglove.FrameTransforms
class RecordingMessages {
 public:
  /// What becomes of each message; `spec` is the same object for all messages of a channel.
  using Sink = std::function<void(const McapChannelSpec& spec, const McapMessage& message)>;

  explicit RecordingMessages(const RecordContent& content) : content_(content) {}

  /// `log_time` is when it is recorded; it should not fall. The data of a message live for the call of `sink` only.
  void put(const Frame& frame, Nanoseconds log_time, const Sink& sink);
  void put(const Scene& scene, Nanoseconds log_time, const Sink& sink);

 private:
  struct Channel {
    McapChannelSpec spec;
    std::uint32_t next_sequence = 0;
    Nanoseconds last{-1};  ///< Log time of its last message; -1: none yet.
  };
  Channel& channel(const std::string& topic, std::string_view schema);
  bool is_due(const std::string& topic, Nanoseconds log_time, Nanoseconds period);
  template <class Message>
  void send(const std::string& topic, const Message& message, Nanoseconds log_time, Nanoseconds publish_time, const Sink& sink);

  RecordContent content_;
  std::map<std::string, Channel> channels_;               ///< By topic.
  std::map<std::string, Nanoseconds> last_;               ///< Of what comes again after a while.
  std::string bytes_;
};

/// The frame that a FrameInfo speaks of, without its images, and the scale of its depth image in `depth.scale_m`.
/// Errors: kTooLarge, kCorruptData, kInvalidArgument (camera).
Result<Frame> frame_from_info(std::string_view payload);

/// A foxglove.RawImage. Errors: kTooLarge, kCorruptData (a size that does not fit), kUnsupported (another encoding, named).
Result<DepthImage> depth_from_raw_image(std::string_view payload, double scale_m);     ///< 16UC1, mono16.
Result<Image<Rgb8>> color_from_raw_image(std::string_view payload);                    ///< rgb8, bgr8, mono8.
Result<CameraModel> camera_from_calibration(std::string_view payload);                 ///< A foxglove.CameraCalibration.

/// Puts recorded scenes together again: feed it every message of kRecordedMeshTopic, then scenes.
class RecordedScenes {
 public:
  Result<void> put_topology(std::string_view payload);
  Result<Scene> scene(std::string_view payload) const;

 private:
  std::map<std::uint64_t, std::shared_ptr<const Topology>> topologies_;
};

}  // namespace gfp::wire
