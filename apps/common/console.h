// The standard streams of the programs, which may be closed, or end in a full disk or a pipe that nobody
// reads. Text that cannot be written never ends the work: lost messages are forgotten, lost results cost the
// exit code.
#pragma once

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace relief {

/// Call first in main. Descriptors 0 to 2 that are closed get /dev/null, so that no file of the program takes
/// their numbers; a pipe whose reader has gone becomes a failed write instead of a signal.
void open_console();

/// Writes to standard output, or to standard error. Neither throws.
void write_output(std::string_view text);
void write_error(std::string_view text);

template <class... Values> void print_output(fmt::format_string<Values...> text, Values&&... values) {
    write_output(fmt::format(text, std::forward<Values>(values)...));
}

template <class... Values> void print_error(fmt::format_string<Values...> text, Values&&... values) {
    write_error(fmt::format(text, std::forward<Values>(values)...));
}

/// Brings what was printed to its reader. False: some of it was lost, now or before.
bool flush_output();

/// Call last in main with the exit code so far. Reports lost output on standard error, and returns 1 instead
/// of 0 for it. A reader that has gone (`| head`) gets no message.
int close_console(int exit_code);

} // namespace relief
