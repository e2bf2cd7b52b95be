#include "bumblebee/fake/gvsp_packets.hpp"

#include <algorithm>

#include "bumblebee/fake/big_endian.hpp"

namespace gfp {
namespace {

enum class Content : std::uint8_t { kLeader = 1, kTrailer = 2, kPayload = 3, kMultiPart = 7 };
constexpr std::uint16_t kImage = 0x0001, kParts = 0x000A, kTwoDimensional = 0x0001;  // payload types, and a part's
constexpr std::size_t kIpAndUdp = 28, kHeader = 8, kExtendedHeader = 20, kPartHeader = 8;

void write_geometry(BigEndianWriter& to, const GigeFormat& format) {
  const std::uint32_t offset = 0;
  const std::uint16_t padding = 0;
  to << static_cast<std::uint32_t>(format.width) << static_cast<std::uint32_t>(format.height) << offset << offset << padding << padding;
}

void write_part(BigEndianWriter& to, const GigeFormat& format, int part) {
  const std::uint64_t length = format.part_bytes();
  to << kTwoDimensional << static_cast<std::uint16_t>(length >> 32) << static_cast<std::uint32_t>(length) << format.pixel_format;
  to << std::uint16_t{0} << static_cast<std::uint8_t>(part) << std::uint8_t{0} << std::uint32_t{0};  // source of the part, zones
  to << std::uint16_t{0} << std::uint16_t{0};                                                        // purpose, region
  write_geometry(to, format);
  to << std::uint32_t{0};
}

}  // namespace

std::size_t GigeFormat::part_bytes() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * ((pixel_format >> 16 & 0xFF) / 8); }

std::span<const std::uint8_t> GvspPackets::operator[](std::size_t i) const {
  const std::size_t end = i + 1 < begins_.size() ? begins_[i + 1] : bytes_.size();
  return std::span(bytes_).subspan(begins_[i], end - begins_[i]);
}

GvspPackets GvspPackets::of_transfer(const GigeFormat& format, std::span<const std::uint8_t> data, std::uint64_t frame, std::uint64_t timestamp_ns, std::size_t packet_bytes) {
  GvspPackets packets;
  BigEndianWriter to(packets.bytes_);
  const bool is_extended = format.parts > 1;
  const auto begin = [&](Content content, std::uint8_t parts = 0) {
    const auto number = static_cast<std::uint32_t>(packets.begins_.size());
    const std::uint32_t kind = static_cast<std::uint32_t>(content) << 24;
    packets.begins_.push_back(packets.bytes_.size());
    to << std::uint16_t{0};  // status
    if (is_extended) to << std::uint16_t{0} << (kind | 0x80000000U | parts) << frame << number;
    else to << static_cast<std::uint16_t>(1 + (frame - 1) % 0xFFFF) << (kind | number);
  };
  const std::uint16_t type = is_extended ? kParts : kImage;

  begin(Content::kLeader, static_cast<std::uint8_t>(format.parts));
  to << std::uint16_t{0} << type << timestamp_ns;
  if (is_extended) for (int part = 0; part < format.parts; ++part) write_part(to, format, part);
  else write_geometry(to << format.pixel_format, format);

  const std::size_t block = packet_bytes - kIpAndUdp - (is_extended ? kExtendedHeader + kPartHeader : kHeader);
  for (int part = 0; part < format.parts; ++part)
    for (std::size_t offset = 0; offset < format.part_bytes(); offset += block) {
      const std::size_t at = static_cast<std::size_t>(part) * format.part_bytes() + offset;
      begin(is_extended ? Content::kMultiPart : Content::kPayload);
      if (is_extended) to << static_cast<std::uint8_t>(part) << std::uint8_t{0} << std::uint16_t{0} << static_cast<std::uint32_t>(at);  // of the transfer, not of the part
      to << data.subspan(at, std::min(block, format.part_bytes() - offset));
    }

  begin(Content::kTrailer);
  to << std::uint16_t{0} << type << static_cast<std::uint32_t>(format.height);
  return packets;
}

}  // namespace gfp
