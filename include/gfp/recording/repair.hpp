#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "gfp/recording/mcap_scan.hpp"

namespace gfp {

struct RepairReport {
  enum class Outcome {
    kSound,        ///< Closed, with a summary that is right: nothing was done.
    kClosed,       ///< Summary and end were added; no message was lost but what was being written when it broke off.
    kLost,         ///< Chunks were damaged: what they held is gone, everything else is there.
  };
  Outcome outcome = Outcome::kSound;
  std::uint64_t messages = 0, chunks = 0;  ///< That are there now.
  std::vector<McapDamage> damage;          ///< Of the file as it was: what was left out.
};

/// Makes a readable file out of one that was not closed (a kill, a power loss) or is damaged, in place: only bytes behind the last
/// whole chunk are written over. Where something before is damaged, a copy without it takes the file's place in one step.
/// Errors: kNotFound, kIo, kCorruptData (no MCAP file, or no message in it: it is left as it is), kTooLarge.
Result<RepairReport> repair_mcap(const std::filesystem::path& file, const McapReadOptions& options = {});

/// The same into another file, which must not exist; `file` is only read. A sound file is copied.
Result<RepairReport> repair_mcap_to(const std::filesystem::path& file, const std::filesystem::path& output, const McapReadOptions& options = {});

}  // namespace gfp
