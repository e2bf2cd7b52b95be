#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/frame/stereo_pair.hpp"

namespace gfp {

struct FakeBumblebeeOptions {
  std::string address = "127.0.0.1";
  std::string serial = "GFPBB01";
  double rate_hz = 30;
  double lost_packets = 0;  ///< Share of the packets that are not sent.
};

/// A camera of Aravis' making on a real network interface (GVCP and GVSP over UDP) that sends the given pairs in turn, as byte-interleaved Mono16, the right
/// eye's byte first. Lives on a thread of its own; one an address.
class FakeBumblebee {
 public:
  /// Pairs of equal size. Errors: kInvalidArgument (none, or of different sizes), kIo (the address or its port 3956 cannot be had).
  static Result<std::unique_ptr<FakeBumblebee>> start(const std::vector<StereoPair>& pairs, const FakeBumblebeeOptions& options = {});
  ~FakeBumblebee();  ///< As if it were unplugged.
  FakeBumblebee(const FakeBumblebee&) = delete;
  FakeBumblebee& operator=(const FakeBumblebee&) = delete;

  std::uint64_t sent() const;  ///< Pictures, whole or not. Safe from any thread.

  struct Show;

 private:
  FakeBumblebee();
  std::unique_ptr<Show> show_;
};

}  // namespace gfp
