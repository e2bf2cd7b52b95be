#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bumblebee/bumblebee_options.hpp"
#include "bumblebee/camera_link.hpp"

namespace gfp {

/// One GenICam camera (GigE Vision or USB3 Vision), streaming from open() to its end. One thread at a time.
class AravisCamera final : public CameraLink {
 public:
  /// Opens, sets, and starts. Errors: kDeviceLost (not there, or gone meanwhile), kUnsupported (a setting that it refuses).
  static Result<std::unique_ptr<AravisCamera>> open(const std::string& device, const BumblebeeOptions& options);
  ~AravisCamera() override;
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  Result<Transfer> next(std::chrono::milliseconds timeout) override;

 private:
  struct Handles;
  AravisCamera();
  Result<void> configure(const BumblebeeOptions& options);
  Result<void> start(const BumblebeeOptions& options);

  std::unique_ptr<Handles> handles_;
  std::string model_;
};

std::vector<LinkedCamera> list_aravis_cameras();

}  // namespace gfp
