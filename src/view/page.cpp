#include "view/page.hpp"

#ifdef GFP_PAGE_FILE
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    "gfp_page_begin:\n"
    ".incbin \"" GFP_PAGE_FILE "\"\n"
    "gfp_page_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {
extern const char gfp_page_begin[] __attribute__((visibility("hidden")));
extern const char gfp_page_end[] __attribute__((visibility("hidden")));
}
#endif

namespace gfp::view {

#ifdef GFP_PAGE_FILE

std::string page() { return {gfp_page_begin, gfp_page_end}; }
bool page_is_compressed() { return true; }

#else

std::string page() {
  return "<!doctype html><html lang=en><meta charset=utf-8><title>gfpd</title><p>This gfpd was built without its page: npm was not there. "
         "Foxglove's viewers can connect to this address (Foxglove WebSocket).";
}
bool page_is_compressed() { return false; }

#endif

}  // namespace gfp::view
