#pragma once

#include <string>

#include "gfp/core/fields.hpp"

namespace gfp {

struct BumblebeeOptions {
  std::string sensor = "bumblebee";     ///< Name of the source, as in topics.
  std::string transport = "aravis";     ///< `aravis`: GigE Vision, USB3 Vision; `firewire`: IIDC through libdc1394.
  std::string firewire_library = "libdc1394.so.25";
  std::string device;                   ///< Aravis' name of the camera, its serial or its address; FireWire: its GUID; empty: the first one. Two cameras: `LEFT,RIGHT`.
  std::string layout = "interleaved";   ///< `interleaved`: pixels of one byte an eye, two or three of them; `stacked`: the left picture above the right one, or two parts; `two_devices`.
  std::string first_byte = "right";     ///< `interleaved`: whose byte comes first.
  std::string eyes = "outer";           ///< Of three: `outer`, `left_centre` or `centre_right`; the calibration is that of the two.
  std::string bayer = "none";           ///< Pattern of the colour filter, as `rggb`; none: grey.
  std::string pixel_format;             ///< To be asked for, as `Mono16`; empty: as the camera stands.
  double rate_hz = 30;                  ///< To be asked for; 0: as the camera stands.
  double exposure_us = 0;               ///< 0: as the camera stands.
  int packet_bytes = 1400;              ///< GigE: 1400 passes everywhere; 8000 where every link has jumbo frames costs less.
  int packet_delay_ns = 0;              ///< GigE: pause between packets, for several cameras on one link.
  int socket_buffer_bytes = 4 << 20;    ///< GigE: what the kernel may hold; at most net.core.rmem_max.
  bool color = true;                    ///< With a Bayer pattern.
  double pair_tolerance_s = 0.005;      ///< `two_devices`: pictures that arrive within this are one pair.
  int threads = 2;                      ///< So many pairs are matched at a time; they come out in their order.
};

template <class Visitor>
void visit_fields(BumblebeeOptions& o, Visitor&& field) {
  field("transport", o.transport, OneOf{{"aravis", "firewire"}});
  field("firewire_library", o.firewire_library);
  field("layout", o.layout, OneOf{{"interleaved", "stacked", "two_devices"}});
  field("first_byte", o.first_byte, OneOf{{"right", "left"}});
  field("eyes", o.eyes, OneOf{{"outer", "left_centre", "centre_right"}});
  field("bayer", o.bayer, OneOf{{"none", "rggb", "bggr", "grbg", "gbrg"}});
  field("pixel_format", o.pixel_format);
  field("rate_hz", o.rate_hz, 0.0, 1000.0);
  field("exposure_us", o.exposure_us, 0.0, 1e7);
  field("packet_bytes", o.packet_bytes, 576, 16'384);
  field("packet_delay_ns", o.packet_delay_ns, 0, 1'000'000'000);
  field("socket_buffer_bytes", o.socket_buffer_bytes, 65'536, 1 << 30);
  field("color", o.color);
  field("pair_tolerance_s", o.pair_tolerance_s, 0.0, 1.0);
  field("threads", o.threads, 1, 16);
}

}  // namespace gfp
