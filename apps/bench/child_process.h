// Child processes: found as a shell finds them, run to completion, output lines with their arrival times.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace relief::bench {

struct LogLine {
    double seconds = 0; ///< since the start of the program
    std::string text;   ///< without newline
};

struct ChildResult {
    int exit_code = 0;      ///< 128 + signal if terminated by a signal
    double processor_s = 0; ///< user and system time, summed over threads
    std::vector<LogLine> lines;
};

/// Finds a program in PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs `words[0]`, a path, with the other words as arguments; captures stdout and stderr. `variables` are
/// NAME=VALUE and replace those of this process. Throws Error{failed} if it cannot be started.
ChildResult run_child(const std::vector<std::string>& words, const std::vector<std::string>& variables = {});

/// As run_child, but an exit code other than 0 is an Error{failed} with the command and the end of its
/// output.
ChildResult run_checked(const std::vector<std::string>& words,
                        const std::vector<std::string>& variables = {});

/// The words separated by spaces, for messages.
std::string describe_command(const std::vector<std::string>& words);

} // namespace relief::bench
