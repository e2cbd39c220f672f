// Ctrl-C and SIGTERM during a render. While it loads and prepares, a signal ends the command; later the first
// one cancels the render, and a second one ends the command unless it follows within half a second.
#pragma once

namespace relief::cli {

/// From now on SIGINT and SIGTERM end the command at once, with a message and exit code 128 + signal, until
/// poll_interrupts is called. Call before a scene is loaded or prepared.
void catch_interrupts();

/// From now on the first signal is only recorded: to be called by what asks for it again and again. Thread
/// safe.
void poll_interrupts();

/// From now on there is a picture to be written after a signal. Before, a signal that nobody asks for within
/// 0.15 s ends the command. Thread safe.
void keep_picture();

/// Until the next poll_interrupts a signal ends the command at once: it waits for input and has nothing to
/// write.
void await_input();

/// The caught signal, 0 for none. Thread safe.
int get_interrupt();

} // namespace relief::cli
