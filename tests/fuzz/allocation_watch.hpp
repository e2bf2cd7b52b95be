#pragma once

#include <cstddef>

namespace gfp::test {

/// Counts what operator new is asked for while it lives, in this program. One at a time, one thread.
class AllocationWatch {
 public:
  AllocationWatch();
  ~AllocationWatch();
  std::size_t largest_bytes() const;  ///< Of one request.
};

}  // namespace gfp::test
