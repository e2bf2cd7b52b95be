#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bumblebee/bumblebee_options.hpp"
#include "bumblebee/camera_link.hpp"

namespace gfp {

class Dc1394Api;

/// One IIDC camera on FireWire through libdc1394, which is found at run time: Bumblebee2 (16-bit pixels of one byte an eye) and XB3 (24-bit, one byte an
/// eye). Format 7 mode 3 at full size, as these cameras have it.
class FirewireCamera final : public CameraLink {
 public:
  /// `device`: GUID as 16 hexadecimal digits, empty: the first one. Errors: kUnsupported (no libdc1394, a refused setting), kInvalidArgument (no GUID),
  /// kDeviceLost (no bus, or not on it).
  static Result<std::unique_ptr<FirewireCamera>> open(const std::string& device, const BumblebeeOptions& options);
  ~FirewireCamera() override;
  FirewireCamera(const FirewireCamera&) = delete;
  FirewireCamera& operator=(const FirewireCamera&) = delete;

  Result<Transfer> next(std::chrono::milliseconds timeout) override;

 private:
  struct Handles;
  FirewireCamera();
  Result<void> find(const std::string& device);
  Result<void> configure(const BumblebeeOptions& options);
  Result<void> start();

  std::unique_ptr<Handles> handles_;
  std::string model_;
};

/// Empty where there is no libdc1394 or no bus.
std::vector<LinkedCamera> list_firewire_cameras(const std::string& library);

}  // namespace gfp
