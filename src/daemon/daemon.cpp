#include "daemon/daemon.hpp"

#include <malloc.h>
#include <spdlog/spdlog.h>
#include <tbb/task_arena.h>

#include <set>

#include "gfp/core/time.hpp"

namespace gfp {
namespace {

/// Two sensors are configured alike when every field is: the field lists say so.
bool same(const SensorConfig& a, const SensorConfig& b) {
  DaemonOptions left, right;
  left.sensors = {a};
  right.sensors = {b};
  return config::to_yaml(left) == config::to_yaml(right);
}

constexpr std::uint64_t kFlood = 1000;  ///< Refused connections that leave holes in the heap.

HandOver hand_over(const DaemonOptions& options) { return options.lossless ? HandOver::kLossless : HandOver::kLatestWins; }

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::start(DaemonOptions options, DaemonParts parts, std::uint64_t session) {
  if (options.sensors.empty()) return failure(ErrorCode::kInvalidArgument, "sensors: none is configured, expected at least one");
  std::unique_ptr<Daemon> daemon(new Daemon(options, std::move(parts)));
  Daemon& self = *daemon;
  self.recorder_ = std::make_unique<Recorder>(options.recording, hand_over(options));  // before the desk, which may ask for it
  self.desk_ = std::make_unique<ControlDesk>([&self](const v1::ControlRequest& request) { return self.answer(request); });
  const auto to_socket = [&self](PeerReply reply) {
    MutexLock lock(self.mutex_);
    if (self.publisher_) self.publisher_->put(std::move(reply));
  };
  auto publisher = Publisher::start(options.publish, session, [&self, to_socket](PeerRequest request) { self.desk_->put(std::move(request), to_socket); });
  if (!publisher) return tl::unexpected(publisher.error());
  {
    MutexLock lock(self.mutex_);  // the desk may be at work already
    self.publisher_ = std::move(*publisher);
  }
  self.shadow_ = std::make_unique<Shadow>(self.parts_.shadow, *self.publisher_);
  self.pipeline_ = std::jthread([&self](const std::stop_token& stop) { self.run_pipeline(stop); });
  auto sources = daemon->make_sources(options);
  if (!sources) return tl::unexpected(sources.error());
  daemon->start_sensors(options, std::move(*sources));
  return daemon;
}

Daemon::Daemon(DaemonOptions options, DaemonParts parts)
    : parts_(std::move(parts)),
      threads_(options.threads),
      inbox_(hand_over(options)),
      options_(std::move(options)),
      pipeline_options_(std::make_shared<const PipelineOptions>(options_.pipeline)) {}

Daemon::~Daemon() { stop(); }

Result<void> Daemon::reload(DaemonOptions options) {
  if (options.sensors.empty()) return failure(ErrorCode::kInvalidArgument, "sensors: none is configured, expected at least one");
  auto sources = make_sources(options);
  if (!sources) return tl::unexpected(sources.error());
  start_sensors(options, std::move(*sources));
  MutexLock lock(mutex_);
  pipeline_options_ = std::make_shared<const PipelineOptions>(options.pipeline);
  options_ = std::move(options);
  return {};
}

bool Daemon::is_at_work(const SensorConfig& sensor) const {
  MutexLock lock(mutex_);
  const auto found = sensors_.find(sensor.name);
  return found != sensors_.end() && same(found->second->config(), sensor);
}

Result<Daemon::Sources> Daemon::make_sources(const DaemonOptions& options) const {
  Sources sources;
  for (const SensorConfig& sensor : options.sensors) {
    if (is_at_work(sensor)) continue;
    auto source = parts_.make_source(sensor);
    if (!source) return tl::unexpected(source.error());
    sources[sensor.name] = std::move(*source);
  }
  return sources;
}

void Daemon::start_sensors(const DaemonOptions& options, Sources sources) {
  Sensors retired;  // destroyed without the lock: joining takes as long as a grab
  {
    MutexLock lock(mutex_);
    std::set<std::string> kept;
    for (const SensorConfig& sensor : options.sensors)
      if (!sources.contains(sensor.name)) kept.insert(sensor.name);
    for (auto entry = sensors_.begin(); entry != sensors_.end();) {
      const bool stays = kept.contains(entry->first);
      if (!stays) retired.insert(*entry);
      entry = stays ? std::next(entry) : sensors_.erase(entry);
    }
  }
  for (auto& [name, worker] : retired) worker->request_stop();
  retired.clear();
  for (const auto& [name, source] : sources) inbox_.expect(name);  // all, before the first frame of any
  for (const SensorConfig& sensor : options.sensors) {
    const auto source = sources.find(sensor.name);
    if (source == sources.end()) continue;
    auto worker = std::make_shared<SensorWorker>(sensor, std::move(source->second), hand_over(options), inbox_, *publisher_, recorder_.get());
    MutexLock lock(mutex_);
    sensors_[sensor.name] = std::move(worker);
  }
}

void Daemon::run_pipeline(const std::stop_token& stop) {
  tbb::task_arena arena(threads_ > 0 ? threads_ : tbb::task_arena::automatic);
  SceneMemory memory;
  while (const std::optional<FramePtr> frame = inbox_.take(stop)) {
    std::shared_ptr<const PipelineOptions> options;
    {
      MutexLock lock(mutex_);
      options = pipeline_options_;
      last_frames_[(*frame)->sensor] = *frame;
    }
    working_since_ = monotonic_now();
    try {
      PipelineResult result = arena.execute([&] { return parts_.process(**frame, memory, *options); });
      memory = std::move(result.memory);
      const auto scene = std::make_shared<const Scene>(std::move(result.scene));
      recorder_->put(scene);
      publisher_->put(scene);
      if (!options->shadow.empty()) shadow_->put(scene, memory, options);
      MutexLock lock(mutex_);
      last_scenes_[scene->sensor] = scene;
    } catch (const std::exception& error) {  // memory exhausted, or a bug: it costs this frame
      spdlog::error("sensor {} frame {}: {}", (*frame)->sensor, (*frame)->sequence, error.what());
      working_since_ = Nanoseconds(0);
      continue;
    }
    working_since_ = Nanoseconds(0);
    MutexLock lock(mutex_);
    if (const auto sensor = sensors_.find((*frame)->sensor); sensor != sensors_.end())
      sensor->second->statistics().scene_done(monotonic_now() - (*frame)->stamps.monotonic);
  }
}

bool Daemon::is_responsive() const {
  const Nanoseconds since = working_since_;
  return since == Nanoseconds(0) || monotonic_now() - since < kStuckAfter;
}

void Daemon::tick() {
  const std::uint64_t refused_before = refused_;
  for (const Refusal& refusal : publisher_->take_refusals()) {
    spdlog::warn("refused {} connection(s) from {}: {}", refusal.count, refusal.peer, refusal.why);
    refused_ += refusal.count;
  }
  if (refused_ == refused_before && refused_ >= kFlood) {  // it is over: what it left free within the heap goes back to the system
    malloc_trim(0);
    refused_ = 0;
  }
  MutexLock lock(mutex_);
  for (const auto& [name, sensor] : sensors_) {
    sensor->statistics().turn(monotonic_now());
    publisher_->put(sensor->status());
  }
}

void Daemon::stop() {
  Sensors sensors;
  {
    MutexLock lock(mutex_);
    sensors.swap(sensors_);
  }
  for (const auto& [name, sensor] : sensors) sensor->request_stop();
  pipeline_.request_stop();
  sensors.clear();
  if (pipeline_.joinable()) pipeline_.join();
  shadow_.reset();
  if (publisher_) publisher_->stop();  // before the desk, which it may still hand requests to
  desk_.reset();
  recorder_.reset();  // closes the file
}

}  // namespace gfp
