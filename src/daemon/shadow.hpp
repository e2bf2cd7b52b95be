#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "gfp/core/mutex.hpp"
#include "gfp/pipeline/shadow_scene.hpp"
#include "publish/publisher.hpp"

namespace gfp {

/// Runs another method beside the pipeline's own, on one thread that gets what time the others leave, and publishes what it finds.
/// The latest scene waits, older ones are dropped and counted: late work is shed here first. put() is safe from any thread.
class Shadow {
 public:
  using Fit = std::function<Scene(const Scene&, const SceneMemory&, const PipelineOptions&, ShadowMemory&)>;

  Shadow(Fit fit, Publisher& publisher);
  ~Shadow();  ///< Waits for the scene at work.

  /// @param options  with a method in `shadow`. @param memory  after the scene's frame.
  void put(ScenePtr scene, SceneMemory memory, std::shared_ptr<const PipelineOptions> options);

 private:
  struct Job {
    ScenePtr scene;
    SceneMemory memory;
    std::shared_ptr<const PipelineOptions> options;
    std::uint64_t dropped = 0;
  };

  void run(const std::stop_token& stop);

  const Fit fit_;
  Publisher& publisher_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Job> waiting_ GFP_GUARDED_BY(mutex_);
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
