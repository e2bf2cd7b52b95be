#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace gfp::test {

/// GigE Vision's port exists once a machine: tests that need it wait for each other, across programs.
class GigeLock {
 public:
  GigeLock() : descriptor_(open("/tmp/gfp_test_gige.lock", O_CREAT | O_RDWR | O_CLOEXEC, 0666)) { flock(descriptor_, LOCK_EX); }
  ~GigeLock() { close(descriptor_); }
  GigeLock(const GigeLock&) = delete;
  GigeLock& operator=(const GigeLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace gfp::test
