#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "gfp/core/mutex.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/v1/status.pb.h"
#include "publish/control_socket.hpp"

namespace gfp {

using ScenePtr = std::shared_ptr<const Scene>;

/// A value, and how many of its kind it has replaced since the last one was taken.
template <class T>
struct Latest {
  T value;
  std::uint64_t dropped = 0;
};

/// What waits for the publisher thread: the latest value a kind, so that nothing queues without a bound. Ids of lost objects
/// outlive the scene that told them. put() is safe from any thread and wakes whoever polls wake_file(); take() is the
/// publisher's.
class Inbox {
 public:
  struct Content {
    std::map<std::string, Latest<FramePtr>> frames;  ///< By sensor.
    std::map<std::string, Latest<ScenePtr>> scenes;
    std::map<std::string, Latest<ScenePtr>> shadows;
    std::map<std::string, std::set<std::uint64_t>> lost;  ///< Ids that scenes said were lost, replaced scenes among them.
    std::map<std::string, v1::SensorStatus> statuses;
    std::deque<v1::LogRecord> log;
    std::deque<PeerReply> replies;
  };

  Inbox();
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  void put(FramePtr frame);
  void put(ScenePtr scene);
  void put_shadow(ScenePtr scene, std::uint64_t dropped);  ///< `dropped`: scenes that the method did not get to since its last one.
  void put(v1::SensorStatus status);
  void put(v1::LogRecord record);
  void put(PeerReply reply);  ///< As many wait at most as whoever makes them has taken on.
  void wake();

  int wake_file() const { return wake_file_; }  ///< Readable while something waits.
  Content take();

 private:
  static constexpr std::size_t kMaxLogRecords = 256;

  const int wake_file_;
  Mutex mutex_;
  Content content_ GFP_GUARDED_BY(mutex_);
};

}  // namespace gfp
