#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

enum class ReplayFormat { kPcd, kPclzf, kPng, kFakenect };

/// The files of one frame; not read yet.
struct ReplayEntry {
  ReplayFormat format = ReplayFormat::kPcd;
  std::filesystem::path depth;        ///< Or the cloud.
  std::filesystem::path color;        ///< Empty where there is none.
  std::filesystem::path calibration;  ///< Of a pclzf frame; empty where there is none.
  std::optional<Nanoseconds> stamp;   ///< From the file's name or the folder's list.
  double depth_scale_m = 0.001;       ///< The format's own default.
};

/// What is to be replayed, in order: a single file, a TUM-style folder, a folder that libfreenect recorded, or a folder of files in name order (where a capture
/// is there as .pclzf and as .pcd of the same name, only the first is taken).
/// Errors: kNotFound, kUnsupported (a file of no known type, a folder without any), kCorruptData, kTooLarge, kIo.
Result<std::vector<ReplayEntry>> list_replay(const std::filesystem::path& input);

/// The time that a file's name gives: `1305031102.160407` (seconds), or PCL's `frame_20121214T142255.814212` (UTC).
std::optional<Nanoseconds> stamp_from_name(const std::string& stem);

inline constexpr std::size_t kMaxReplayEntries = 1'000'000;

}  // namespace gfp
