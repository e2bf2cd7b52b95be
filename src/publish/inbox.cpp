#include "publish/inbox.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

namespace gfp {
namespace {

template <class T>
void replace(std::map<std::string, Latest<T>>& slots, const std::string& name, T value) {
  const auto [slot, is_new] = slots.try_emplace(name);
  if (!is_new) ++slot->second.dropped;
  slot->second.value = std::move(value);
}

}  // namespace

Inbox::Inbox() : wake_file_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

Inbox::~Inbox() {
  if (wake_file_ >= 0) close(wake_file_);
}

void Inbox::wake() {
  const std::uint64_t one = 1;
  // A full counter (2^64 - 2) is readable too: the result does not matter.
  [[maybe_unused]] const auto written = write(wake_file_, &one, sizeof one);
}

void Inbox::put(FramePtr frame) {
  {
    MutexLock lock(mutex_);
    const std::string name = frame->sensor;
    replace(content_.frames, name, std::move(frame));
  }
  wake();
}

void Inbox::put(ScenePtr scene) {
  {
    MutexLock lock(mutex_);
    const std::string name = scene->sensor;
    auto& lost = content_.lost[name];
    lost.insert(scene->lost.begin(), scene->lost.end());
    for (const SceneObject& object : scene->objects) lost.erase(object.id);  // back again before anybody heard
    replace(content_.scenes, name, std::move(scene));
  }
  wake();
}

void Inbox::put_shadow(ScenePtr scene, std::uint64_t dropped) {
  {
    MutexLock lock(mutex_);
    const std::string name = scene->sensor;
    replace(content_.shadows, name, std::move(scene));
    content_.shadows[name].dropped += dropped;
  }
  wake();
}

void Inbox::put(v1::SensorStatus status) {
  {
    MutexLock lock(mutex_);
    const std::string name = status.sensor();
    content_.statuses[name] = std::move(status);
  }
  wake();
}

void Inbox::put(v1::LogRecord record) {
  {
    MutexLock lock(mutex_);
    if (content_.log.size() >= kMaxLogRecords) content_.log.pop_front();
    content_.log.push_back(std::move(record));
  }
  wake();
}

void Inbox::put(PeerReply reply) {
  {
    MutexLock lock(mutex_);
    content_.replies.push_back(std::move(reply));
  }
  wake();
}

Inbox::Content Inbox::take() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(wake_file_, &count, sizeof count);
  MutexLock lock(mutex_);
  return std::exchange(content_, {});
}

}  // namespace gfp
