// Ctrl-C and SIGTERM while a picture is made: the first asks for an orderly end, a second ends at once,
// unless it comes within half a second.
#pragma once

namespace relief::cli {

/// From here on the first SIGINT or SIGTERM is only noted. Call it when there is something worth saving.
void catch_interrupts();

/// The signal that was caught, 0 for none. Any thread.
int get_interrupt();

} // namespace relief::cli
