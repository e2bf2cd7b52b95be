#pragma once

#include <filesystem>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/frame/kinect_depth.hpp"
#include "replay/listing.hpp"

namespace gfp {

/// Whether this is a folder that libfreenect's recorder wrote: one with an INDEX.txt.
bool is_fakenect_folder(const std::filesystem::path& folder);

/// Its depth frames in the order of INDEX.txt, each with the colour image nearest in recorded time (50 ms at most).
/// File names are d-<seconds>-<ticks>.pgm and r-<seconds>-<ticks>.ppm; others (a-....dump: tilt) are passed over.
/// Errors: kNotFound (a listed file is missing), kCorruptData (a name of another form, no depth), kTooLarge, kIo.
Result<std::vector<ReplayEntry>> list_fakenect_folder(const std::filesystem::path& folder);

/// Raw 11-bit depth: `P5 <width> <height> 65535` and little-endian 16-bit values (unlike PGM, which is big-endian).
/// Errors: as read_file(), kCorruptData (another header, a wrong length), kTooLarge (a side above 4096).
Result<Image<std::uint16_t>> read_fakenect_raw(const std::filesystem::path& file);
/// Colour: binary PPM with 8 bits. Errors: as read_fakenect_raw().
Result<Image<Rgb8>> read_fakenect_color(const std::filesystem::path& file);

/// Raw values through the table; 0 where there is no reading.
DepthImage depth_of_raw(const Image<std::uint16_t>& raw, const KinectDepthTable& table);

}  // namespace gfp
