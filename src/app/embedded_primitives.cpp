// The generated PrimitiveSet as bytes of the program, so that it runs from anywhere.
#include "app/embedded_primitives.hpp"

__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    "gfp_embedded_primitives_begin:\n"
    ".incbin \"" GFP_PRIMITIVES_FILE "\"\n"
    "gfp_embedded_primitives_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {
extern const std::byte gfp_embedded_primitives_begin[] __attribute__((visibility("hidden")));
extern const std::byte gfp_embedded_primitives_end[] __attribute__((visibility("hidden")));
}

namespace gfp {

std::span<const std::byte> embedded_primitives() { return {gfp_embedded_primitives_begin, gfp_embedded_primitives_end}; }

}  // namespace gfp
