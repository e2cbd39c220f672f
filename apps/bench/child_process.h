// Other programs: found as a shell finds them, run to their end, with the time at which each line arrived.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace relief::bench {

struct LogLine {
    double seconds = 0; ///< since the program was started
    std::string text;   ///< without its end of line
};

struct ChildResult {
    int exit_code = 0; ///< 128 + signal where a signal ended it
    std::vector<LogLine> lines;
};

/// The program of that name in one of the folders of PATH, if there is one.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs `words[0]`, a path, with the other words as arguments; both its outputs are read, none is shown.
/// Throws Error{failed} where it cannot be started.
ChildResult run_child(const std::vector<std::string>& words);

} // namespace relief::bench
