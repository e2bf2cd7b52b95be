#pragma once

#include <string>

namespace gfp::view {

/// The built-in page: one HTML document with all of its style and program. A build without npm has a page that says so.
std::string page();
bool page_is_compressed();  ///< gzip.

}  // namespace gfp::view
