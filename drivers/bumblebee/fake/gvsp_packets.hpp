#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gfp {

/// What a transfer of a GigE camera is: `parts` pictures of one size, one after the other. One part goes as GVSP's payload type Image, several as Multi-part.
struct GigeFormat {
  int width = 0, height = 0;       ///< Of a part.
  std::uint32_t pixel_format = 0;  ///< GenICam's number (PFNC); its bits 16 to 23 are the bits of a pixel.
  int parts = 1;

  std::size_t part_bytes() const;
};

/// The packets of a transfer, one after the other, and where each begins.
class GvspPackets {
 public:
  std::size_t size() const { return begins_.size(); }
  std::span<const std::uint8_t> operator[](std::size_t i) const;

  /// Leader, payload, trailer (GigE Vision 2.1; fields are big-endian). `data`: parts * part_bytes(). `packet_bytes`: with the headers of IP and UDP.
  /// Parts need the extended numbering of 2.0; a single picture has that of 1.x, whose numbers of frames go from 1 to 65535 and around.
  static GvspPackets of_transfer(const GigeFormat& format, std::span<const std::uint8_t> data, std::uint64_t frame, std::uint64_t timestamp_ns, std::size_t packet_bytes);

 private:
  std::vector<std::uint8_t> bytes_;
  std::vector<std::size_t> begins_;
};

}  // namespace gfp
