// Signals that end the viewer as a user does, so that what was painted is kept.
#pragma once

namespace relief::viewer {

/// SIGINT, SIGTERM and SIGHUP are noted from now on, but for those that are ignored; a second one ends the
/// program at once.
void note_signals();

/// The one that came; 0: none.
int get_signal();

} // namespace relief::viewer
