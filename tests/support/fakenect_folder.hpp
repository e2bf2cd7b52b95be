#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "gfp/frame/frame.hpp"
#include "gfp/frame/kinect_depth.hpp"

namespace gfp::test {

/// Depth as a Kinect's raw values.
inline Image<std::uint16_t> raw_of(const DepthImage& depth) {
  Image<std::uint16_t> raw(depth.pixels.width, depth.pixels.height);
  for (std::size_t i = 0; i < raw.pixels.size(); ++i) raw.pixels[i] = kinect_raw_of(depth.scale_m * depth.pixels.pixels[i]);
  return raw;
}

/// Writes frames as libfreenect's recorder would: INDEX.txt, d-<seconds>-<ticks>.pgm (little-endian raw depth), r-....ppm.
inline void write_fakenect_folder(const std::filesystem::path& folder, const std::vector<Frame>& frames, std::uint32_t first_tick = 1000) {
  std::filesystem::create_directories(folder);
  std::ofstream index(folder / "INDEX.txt");
  for (const Frame& frame : frames) {
    const double seconds = 100 + 1e-9 * static_cast<double>(frame.stamps.sensor.count());
    const auto ticks = static_cast<std::uint32_t>(first_tick + static_cast<std::uint64_t>(frame.stamps.sensor.count()) * 3 / 50);
    const auto put = [&](const std::string& name, const std::string& header, const void* pixels, std::size_t bytes) {
      std::ofstream file(folder / name, std::ios::binary);
      file << header;
      file.write(static_cast<const char*>(pixels), static_cast<std::streamsize>(bytes));
      index << name << "\n";
    };
    if (!frame.color.empty())
      put(fmt::format("r-{:.6f}-{}.ppm", seconds, ticks), fmt::format("P6 {} {} 255\n", frame.color.width, frame.color.height), frame.color.pixels.data(), 3 * frame.color.pixels.size());
    const Image<std::uint16_t> raw = raw_of(frame.depth);
    put(fmt::format("d-{:.6f}-{}.pgm", seconds, ticks), fmt::format("P5 {} {} 65535\n", raw.width, raw.height), raw.pixels.data(), 2 * raw.pixels.size());
  }
}

}  // namespace gfp::test
