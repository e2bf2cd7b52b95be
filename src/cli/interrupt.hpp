#pragma once

namespace gfp {

/// From now on SIGINT and SIGTERM do not kill the command, but are remembered, so that it ends cleanly.
void catch_interrupts();
bool interrupted();

}  // namespace gfp
