#include "daemon/shadow.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <exception>
#include <utility>

namespace gfp {
namespace {

constexpr int kNice = 15;  ///< Of its thread alone, as Linux has it.

}  // namespace

Shadow::Shadow(Fit fit, Publisher& publisher) : fit_(std::move(fit)), publisher_(publisher), thread_([this](const std::stop_token& stop) { run(stop); }) {}

Shadow::~Shadow() = default;

void Shadow::put(ScenePtr scene, SceneMemory memory, std::shared_ptr<const PipelineOptions> options) {
  {
    MutexLock lock(mutex_);
    const std::uint64_t dropped = waiting_ ? waiting_->dropped + 1 : 0;
    waiting_ = Job{std::move(scene), std::move(memory), std::move(options), dropped};
  }
  changed_.notify_all();
}

void Shadow::run(const std::stop_token& stop) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
  tbb::task_arena alone(1);
  ShadowMemory kept;
  while (true) {
    std::optional<Job> job;
    {
      MutexLock lock(mutex_);
      if (!changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return waiting_.has_value(); })) return;
      job.swap(waiting_);
    }
    try {
      auto scene = std::make_shared<Scene>();
      alone.execute([&] { *scene = fit_(*job->scene, job->memory, *job->options, kept); });
      publisher_.put_shadow(std::move(scene), job->dropped);
    } catch (const std::exception& error) {  // memory exhausted, or a bug: it costs this shadow
      spdlog::error("shadow {} of sensor {} frame {}: {}", job->options->shadow, job->scene->sensor, job->scene->sequence, error.what());
    }
  }
}

}  // namespace gfp
