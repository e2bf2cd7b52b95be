#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bumblebee/fake/gvsp_packets.hpp"
#include "gfp/core/error.hpp"

namespace gfp {

struct GigeCameraOptions {
  std::string address = "127.0.0.1";  ///< Of an interface of this machine; all of 127.0.0.0/8 is.
  std::string serial = "GFPBB01";
  double rate_hz = 30;
  double lost_packets = 0;  ///< Share of the packets that are not sent, the first time and when they are asked for again.
  bool resends = true;      ///< Sends packets of the last few frames again to who asks.
};

/// A GigE Vision camera (GVCP and GVSP over real UDP sockets, port 3956) that sends the given transfers in turn; registers and GenICam description are Aravis'.
/// Frames begin at multiples of the period of the host's CLOCK_MONOTONIC: cameras of one machine send together, as with one trigger. One client at a time has
/// control, until it gives it up or is silent for the time of its heartbeat. Lives on a thread of its own; one an address.
class GigeCamera {
 public:
  /// `transfers`: of format.parts * format.part_bytes() each. Errors: kIo (the address or its port cannot be had).
  static Result<std::unique_ptr<GigeCamera>> start(const GigeFormat& format, std::vector<std::vector<std::uint8_t>> transfers, const GigeCameraOptions& options);
  ~GigeCamera();  ///< As if it were unplugged.
  GigeCamera(const GigeCamera&) = delete;
  GigeCamera& operator=(const GigeCamera&) = delete;

  std::uint64_t sent() const;    ///< Transfers, whole or not. Safe from any thread.
  std::uint64_t resent() const;  ///< Packets that were asked for again and sent. Safe from any thread.

 private:
  class Device;
  explicit GigeCamera(std::unique_ptr<Device> device);
  std::unique_ptr<Device> device_;
};

}  // namespace gfp
