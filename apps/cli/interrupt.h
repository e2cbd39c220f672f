// Ctrl-C and SIGTERM during a render: the first signal cancels, a second one terminates immediately unless it
// follows within half a second.
#pragma once

namespace relief::cli {

/// From now on the first SIGINT or SIGTERM is only recorded. Call once there is something to save.
void catch_interrupts();

/// The caught signal, 0 for none. Thread safe.
int get_interrupt();

} // namespace relief::cli
