#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "config/daemon_options.hpp"
#include "daemon/control_desk.hpp"
#include "daemon/frame_inbox.hpp"
#include "daemon/recorder.hpp"
#include "daemon/sensor_worker.hpp"
#include "daemon/shadow.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "publish/publisher.hpp"

namespace gfp {

/// What a primitive's points are after a person's word on some of them.
struct RetypedPrimitive {
  std::string name;
  std::string file;  ///< That holds it; empty where nothing was changed.
  int changed = 0;   ///< Vertices.
  std::vector<PointType> types;
  std::vector<std::optional<PointType>> manual;  ///< One a vertex, or none at all.
};

/// What the daemon is given, so that tests can give it something else.
struct DaemonParts {
  using Retype = std::function<Result<RetypedPrimitive>(const std::string& primitive, const std::vector<std::uint32_t>& vertices, std::optional<PointType> type)>;

  std::function<Result<std::unique_ptr<FrameSource>>(const SensorConfig&)> make_source;
  std::function<PipelineResult(const Frame&, const SceneMemory&, const PipelineOptions&)> process;
  Shadow::Fit shadow;
  Retype retype;  ///< Called on the desk's thread.
};

/// gfpd without its command line: sensors, one pipeline, one publisher, and a recorder where one is configured.
///
///     SensorWorker (2 threads each) --FrameInbox--> pipeline thread (oneTBB arena) --> Publisher (1 thread)
///               `------------------ frames, scenes -----------------|---------------> Recorder (1 thread)
///                                                                   `--> Shadow (1 thread, low priority) --> Publisher
///                                                              control requests <--> ControlDesk (1 thread)
///
/// start(), reload(), tick() and stop() belong to one thread, the one that waits for signals.
class Daemon {
 public:
  /// Errors: as Publisher::start() and make_source; kInvalidArgument where no sensor is configured.
  static Result<std::unique_ptr<Daemon>> start(DaemonOptions options, DaemonParts parts, std::uint64_t session);
  ~Daemon();  ///< As stop().

  /// Takes over a new configuration: sensors that are configured as before go on without losing a frame, others are stopped,
  /// started or started anew; the pipeline's options hold from the next frame on. Endpoints, thread count and
  /// recording stay until the next start. On an error nothing has changed. Errors: as start().
  Result<void> reload(DaemonOptions options);

  void tick();  ///< Once a second: statistics and statuses.
  bool is_responsive() const;  ///< No frame has been at work for longer than kStuckAfter.
  void stop();  ///< Drains: the frame at work becomes a scene, the last state is sent. Idempotent.

  /// A request that does not come over a socket of the publisher's. Safe from any thread while the daemon lives.
  void ask(PeerRequest request, ControlDesk::Send send) { desk_->put(std::move(request), std::move(send)); }

  Publisher& publisher() { return *publisher_; }
  Recorder& recorder() { return *recorder_; }

 private:
  Daemon(DaemonOptions options, DaemonParts parts);

  using Sensors = std::map<std::string, std::shared_ptr<SensorWorker>>;
  using Sources = std::map<std::string, std::unique_ptr<FrameSource>>;

  /// Sources of the sensors in `options` that are not at work as configured. Errors: of make_source; then nothing was made.
  Result<Sources> make_sources(const DaemonOptions& options) const;
  void start_sensors(const DaemonOptions& options, Sources sources);
  bool is_at_work(const SensorConfig& sensor) const;
  void run_pipeline(const std::stop_token& stop);

  v1::ControlReply answer(const v1::ControlRequest& request);
  v1::ControlReply answer_fit(const v1::ControlRequest& request);
  v1::ControlReply answer_grasp(const v1::ControlRequest& request);
  v1::ControlReply answer_set_parameters(const v1::ControlRequest& request);
  v1::ControlReply answer_retype(const v1::ControlRequest& request) const;
  v1::ControlReply answer_record(const v1::ControlRequest& request);

  static constexpr Nanoseconds kStuckAfter{20'000'000'000};

  const DaemonParts parts_;
  const int threads_;  ///< Of the pipeline; 0: one a core.
  std::unique_ptr<Recorder> recorder_;
  FrameInbox inbox_;
  mutable Mutex mutex_;
  DaemonOptions options_ GFP_GUARDED_BY(mutex_);
  std::shared_ptr<const PipelineOptions> pipeline_options_ GFP_GUARDED_BY(mutex_);
  std::map<std::string, FramePtr> last_frames_ GFP_GUARDED_BY(mutex_);  ///< By sensor, as those below.
  std::map<std::string, ScenePtr> last_scenes_ GFP_GUARDED_BY(mutex_);
  Sensors sensors_ GFP_GUARDED_BY(mutex_);
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<ControlDesk> desk_;
  std::unique_ptr<Shadow> shadow_;
  std::uint64_t refused_ = 0;                 ///< Connections since the heap was last trimmed; of the thread that ticks.
  std::atomic<Nanoseconds> working_since_{};  ///< Monotonic; 0: the pipeline waits for a frame.
  std::jthread pipeline_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
