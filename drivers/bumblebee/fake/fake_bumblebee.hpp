#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bumblebee/fake/gige_camera.hpp"
#include "gfp/core/error.hpp"
#include "gfp/frame/stereo_pair.hpp"

namespace gfp {

struct FakeBumblebeeOptions {
  GigeCameraOptions camera;
  std::string layout = "interleaved";  ///< `interleaved`: Mono16, the right eye's byte first; `stacked`: Mono8, the left picture above the right one; `parts`: the same as two parts; `left`, `right`: one eye, Mono8.
};

/// A stereo camera, or one of its eyes, on a real network interface that sends the given pairs in turn.
class FakeBumblebee {
 public:
  /// Pairs of equal size. Errors: kInvalidArgument (none, of different sizes, another layout), kIo (the address or its port 3956 cannot be had).
  static Result<std::unique_ptr<FakeBumblebee>> start(const std::vector<StereoPair>& pairs, const FakeBumblebeeOptions& options = {});

  std::uint64_t sent() const { return camera_->sent(); }      ///< Pictures, whole or not. Safe from any thread.
  std::uint64_t resent() const { return camera_->resent(); }  ///< Packets that were sent again. Safe from any thread.

 private:
  explicit FakeBumblebee(std::unique_ptr<GigeCamera> camera) : camera_(std::move(camera)) {}
  std::unique_ptr<GigeCamera> camera_;
};

}  // namespace gfp
