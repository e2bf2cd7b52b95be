#pragma once

#include <condition_variable>
#include <mutex>

// Clang's thread-safety analysis (-Wthread-safety); nothing elsewhere. libstdc++'s own types carry no annotations.
#if defined(__clang__)
#define GFP_THREAD_ATTRIBUTE(attribute) __attribute__((attribute))
#else
#define GFP_THREAD_ATTRIBUTE(attribute)
#endif
#define GFP_GUARDED_BY(mutex) GFP_THREAD_ATTRIBUTE(guarded_by(mutex))
#define GFP_REQUIRES(mutex) GFP_THREAD_ATTRIBUTE(requires_capability(mutex))

namespace gfp {

/// std::mutex that the analysis understands. Keep it beside the members that it guards, which say GFP_GUARDED_BY(it).
class GFP_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
 public:
  void lock() GFP_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
  void unlock() GFP_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }

 private:
  std::mutex mutex_;
};

/// Holds a Mutex for a scope; a condition variable may let it go while it waits.
class GFP_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) GFP_THREAD_ATTRIBUTE(acquire_capability(mutex)) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() GFP_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;
  void lock() GFP_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
  void unlock() GFP_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }

 private:
  Mutex& mutex_;
};

}  // namespace gfp
