#pragma once

#include <filesystem>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// The beginning of a page of figures: its head with the style that all our pages share, an optional script, and a heading.
std::string page_start(const std::string& title, const std::string& script = {});

/// Text as it may stand in HTML.
std::string escaped(const std::string& text);

/// Errors: kIo.
Result<void> write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace gfp
