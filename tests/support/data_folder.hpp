#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#ifndef GFP_SOURCE_DIR
#define GFP_SOURCE_DIR "."
#endif

namespace gfp::test {

/// Where real recordings and meshes are: $GFP_DATA_DIR, else ../shared/data beside the sources. May not exist.
inline std::filesystem::path data_folder() {
  if (const char* given = std::getenv("GFP_DATA_DIR")) return given;
  return std::filesystem::path(GFP_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace gfp::test

/// Skips a test that needs real data where there is none, saying what is missing.
#define GFP_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data at " << (path) << " (set GFP_DATA_DIR)"
