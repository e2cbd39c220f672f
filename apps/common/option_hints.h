// Hints for misspelt and foreign names of options and commands: what users of other renderers type.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/cli_app.h"

namespace relief::cli {

/// The hint for an option that `app` lacks, e.g. "did you mean '--size 800xH'?" for --width with `value` 800.
/// First other programs' names for options of `app`, then prefixes, then few typing mistakes in long names;
/// empty where nothing is near. `value`: the argument behind it, may be empty.
std::string suggest_option(std::string_view word, std::string_view value, const CLI::App& app);

/// The same for a command; `word` may also be a file.
std::string suggest_command(std::string_view word, std::span<const std::string_view> commands);

/// Throws Error{usage} for a long name behind one dash (-spp 64, -output a.exr), of which one-letter options
/// would take the rest as their value. `app`: with the commands as subcommands, or without any.
void refuse_single_dashes(const CLI::App& app, int argument_count, const char* const* arguments);

} // namespace relief::cli
