#pragma once

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gfp/client/subscriber.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

struct ControlOptions {
  std::string endpoint;  ///< Empty: this host's gfpd.
  std::chrono::milliseconds timeout{5000};
  CurveAccess curve;
};

/// The last value of one topic, as the daemon holds it.
struct TopicState {
  std::string topic;
  std::string schema;
  std::uint64_t next_seq = 0;  ///< Messages of the topic from here on are newer.
  std::string payload;
};

/// The last values of all topics that were asked for, in one session of the daemon.
struct StateSnapshot {
  std::uint64_t session = 0;
  std::vector<TopicState> topics;
};

/// A grasp that the robot reaches, in the frame of its base.
struct ReachableGrasp {
  Grasp grasp;
  Transform T_base_tcp = Transform::Identity();
  Transform T_base_parent = Transform::Identity();
  Transform T_base_pregrasp_tcp = Transform::Identity();
};

/// The daemon's own recorder, as proto/gfp/v1/control.proto says it in `Recording`.
struct RecorderState {
  std::string mode, state, file;
  std::uint64_t files = 0, messages = 0, bytes = 0, lost_messages = 0;
  std::string last_error;
};
enum class RecorderAction { kStatus, kStart, kStop, kTrigger };

/// Asks a gfpd (proto/gfp/v1/control.proto). One thread at a time. Errors of all calls: kTimeout (no answer in time, or the daemon
/// is busy: ask again), kInvalidArgument and kNotFound (as the daemon says), kCorruptData (not an answer), kIo.
class ControlClient {
 public:
  /// Errors: kInvalidArgument (half a key), kIo (an endpoint that ZeroMQ refuses). A daemon that is not there yet is not an error.
  static Result<ControlClient> connect(const ControlOptions& options = {});
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;
  ~ControlClient();

  /// Subscribe first, then ask, then apply the messages from `next_seq` on: that is how a late joiner misses nothing.
  Result<StateSnapshot> snapshot(const std::string& prefix = "");

  /// Fits anew what stands in the sensor's last frame: objects whose box has its centre in `region_px` (u0 v0 u1 v1, half-open).
  Result<Scene> fit(const std::string& sensor = "", const std::optional<std::array<int, 4>>& region_px = {});

  /// The best grasp of an object that the robot reaches. kNotFound says why there is none.
  Result<ReachableGrasp> best_grasp(std::uint64_t object, const std::string& sensor = "");

  Result<std::map<std::string, std::string>> parameters(const std::vector<std::string>& prefixes = {});
  Result<std::map<std::string, std::string>> set_parameters(const std::map<std::string, std::string>& values);  ///< Those after the change.

  /// Starts or stops the daemon's recorder, or makes a file of its ring. kInvalidArgument: a trigger where no ring is filled.
  Result<RecorderState> recorder(RecorderAction action);

 private:
  struct Link;
  explicit ControlClient(std::unique_ptr<Link> link);
  std::unique_ptr<Link> link_;
};

}  // namespace gfp
