#include "daemon/sensor_worker.hpp"

#include <spdlog/spdlog.h>

namespace gfp {
namespace {

constexpr Nanoseconds kHangMargin = std::chrono::milliseconds(500);  // beyond the timeout that a grab was given

}  // namespace

Result<Frame> WatchedSource::grab(std::chrono::milliseconds timeout) {
  due_ns_ = (monotonic_now() + timeout + kHangMargin).count();
  Result<Frame> frame = source_->grab(timeout);
  due_ns_ = kNever;
  return frame;
}

bool WatchedSource::hangs() const { return monotonic_now().count() > due_ns_; }

SensorWorker::SensorWorker(SensorConfig config, std::unique_ptr<FrameSource> source, HandOver policy, FrameInbox& inbox, Publisher& publisher, Recorder* recorder)
    : config_(std::move(config)),
      source_(std::move(source)),
      info_(source_.info()),
      inbox_(inbox),
      publisher_(publisher),
      recorder_(recorder),
      statistics_(monotonic_now()),
      slot_(policy),
      relay_([this](const std::stop_token& stop) { relay(stop); }),
      driver_([this](const std::stop_token& stop) { drive(stop); }) {}

SensorWorker::~SensorWorker() { request_stop(); }

void SensorWorker::request_stop() {
  driver_.request_stop();
  relay_.request_stop();
}

void SensorWorker::drive(const std::stop_token& stop) {
  const SourceStatus last = run_source(source_, slot_, config_.source, stop, [this](const SourceStatus& status) { changed(status); });
  changed(last);
}

void SensorWorker::relay(const std::stop_token& stop) {
  while (std::optional<FramePtr> frame = slot_.take(stop)) {
    statistics_.frame_arrived();
    publisher_.put(*frame);
    if (recorder_ != nullptr) recorder_->put(*frame);
    inbox_.put(std::move(*frame), stop);
  }
  inbox_.finished(config_.name);
}

void SensorWorker::changed(const SourceStatus& status) {
  SourceStatus before;
  {
    MutexLock lock(mutex_);
    before = std::exchange(source_status_, status);
  }
  publisher_.put(this->status());
  if (before.state == status.state && before.fault == status.fault) return;
  const bool is_trouble = status.state == SourceState::kLost || status.state == SourceState::kFailed || status.state == SourceState::kStalled;
  const std::string why = is_trouble && status.last_error ? ": " + status.last_error->what : "";
  const std::string fault = status.fault.empty() ? "" : " (" + std::string(status.fault) + ")";
  spdlog::log(is_trouble || !fault.empty() ? spdlog::level::warn : spdlog::level::info, "sensor {} is {}{}{}", config_.name, to_string(status.state), fault, why);
}

v1::SensorStatus SensorWorker::status() const {
  SourceStatus source;
  {
    MutexLock lock(mutex_);
    source = source_status_;
  }
  const SensorStatistics::Rates rates = statistics_.rates();
  v1::SensorStatus status;
  status.set_sensor(config_.name);
  const bool hangs = source_.hangs();
  status.set_state(std::string(to_string(hangs ? SourceState::kStalled : source.state)));
  status.set_fault(std::string(hangs ? fault::kHang : source.fault));
  status.set_clock_state(std::string(source.clock_state));
  status.set_driver(info_.driver);
  status.set_model(info_.model);
  status.set_serial(info_.serial);
  status.set_fps(rates.fps);
  status.set_scenes_fps(rates.scenes_fps);
  status.set_latency_p50_ms(rates.latency_p50_ms);
  status.set_latency_p99_ms(rates.latency_p99_ms);
  status.set_frames(rates.frames);
  status.set_frames_dropped(slot_.dropped() + inbox_.dropped(config_.name));
  status.set_timeouts(source.timeouts);
  status.set_corrupt_frames(source.corrupt_frames);
  status.set_reconnects(source.reconnects);
  if (source.last_error) status.set_last_error(source.last_error->what);
  return status;
}

}  // namespace gfp
