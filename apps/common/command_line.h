// What the programs share of a command line: parsing with CLI11, and errors on stderr with their exit codes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/cli_app.h"

namespace relief::cli {

/// Runs a command whose options have been parsed and returns the exit code; bad input and failures are
/// relief::Error.
using Command = std::function<int()>;

/// Calls `body`; an exception becomes a message on stderr and its exit code. std::bad_alloc counts as
/// ErrorKind::out_of_memory, any other that is not a relief::Error as ErrorKind::failed.
int run_guarded(const std::function<int()>& body);

/// Gives the help its format and collects unknown words, so that messages can name the nearest option.
void prepare_parsing(CLI::App& app);

/// The exit code where --help or --version has been answered. Throws Error{usage}.
std::optional<int> parse_words(CLI::App& app, int argument_count, const char* const* arguments);

/// Throws Error{usage} where words are left that `app` does not know. `command`: as the user types it.
void refuse_extras(const CLI::App& app, const std::string& command);

/// Throws Error{usage} with the nearest option, or else the help, as the hint.
[[noreturn]] void refuse_option(const std::string& word, const CLI::App& app, const std::string& help);

} // namespace relief::cli
