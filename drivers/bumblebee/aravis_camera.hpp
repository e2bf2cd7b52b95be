#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bumblebee/bumblebee_options.hpp"
#include "bumblebee/decode_stereo.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// One complete transfer, copied out of Aravis' buffer.
struct Transfer {
  std::vector<std::uint8_t> bytes;
  std::uint64_t number = 0;  ///< Of the camera's pictures since it was opened, lost ones and ones that were left out counted.
  int width = 0, height = 0, bytes_per_pixel = 1;
  Nanoseconds device{};    ///< Camera's clock.
  Nanoseconds arrival{};   ///< Of its first packet, host CLOCK_MONOTONIC.

  RawPicture picture() const { return {width, height, bytes_per_pixel, bytes}; }
};

/// One GenICam camera (GigE Vision or USB3 Vision), streaming from open() to its end. One thread at a time.
class AravisCamera {
 public:
  /// Opens, sets, and starts. Errors: kDeviceLost (not there, or gone meanwhile), kUnsupported (a setting that it refuses).
  static Result<std::unique_ptr<AravisCamera>> open(const std::string& device, const BumblebeeOptions& options);
  ~AravisCamera();
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  const std::string& model() const { return model_; }
  const std::string& serial() const { return serial_; }

  /// The oldest picture that waits; where more wait than a short pause explains, the newest. Errors: kTimeout, kCorruptFrame (packets are missing),
  /// kDeviceLost (control of the camera was lost).
  Result<Transfer> next(std::chrono::milliseconds timeout);

 private:
  struct Handles;
  AravisCamera();
  Result<void> configure(const BumblebeeOptions& options);
  Result<void> start(const BumblebeeOptions& options);

  std::unique_ptr<Handles> handles_;
  std::string model_, serial_;
};

/// A camera that answers on the network or the bus.
struct AravisDevice {
  std::string id, model, serial;
};
std::vector<AravisDevice> list_aravis_devices();

}  // namespace gfp
