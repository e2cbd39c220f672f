// Command-line handling shared by the programs: parsing with CLI11, errors on stderr, exit codes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/cli_app.h"

namespace relief::cli {

/// Runs a parsed command and returns the exit code; reports failures by relief::Error.
using Command = std::function<int()>;

/// Calls `body`; prints an exception on stderr and returns its exit code. std::bad_alloc counts as
/// ErrorKind::out_of_memory, all others but relief::Error as ErrorKind::failed.
int run_guarded(const std::function<int()>& body);

/// The whole of a program: run_guarded between open_console and close_console.
int run_program(const std::function<int()>& body);

/// Groups of options that --help leaves out and --help-all shows.
inline constexpr const char* kResearchGroup = "For research and comparison";
inline constexpr const char* kMapDetailGroup = "Maps, meshes and pictures in detail";

/// Sets the help format and collects unknown arguments, so that errors can suggest the nearest option.
void prepare_parsing(CLI::App& app);

/// Returns the exit code if --help or --version was given. Throws Error{usage}.
std::optional<int> parse_words(CLI::App& app, int argument_count, const char* const* arguments);

/// Throws Error{usage} for arguments unknown to `app`. `command`: as the user types it.
void refuse_extras(const CLI::App& app, const std::string& command);

/// Throws Error{usage} with the option that was probably meant, or else the help command, as the hint.
/// `value`: what follows the word; may be empty.
[[noreturn]] void refuse_option(const std::string& word, const std::string& value, const CLI::App& app,
                                const std::string& help);

/// Throws Error{usage} for an option or argument that names a file or folder and is empty: `-o ""`.
void refuse_empty_names(const CLI::App& app);

} // namespace relief::cli
