// bench: forwards its arguments to relief-bench, which is built and installed separately.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

/// Replaces this process (exec), so that exit code, signals and terminal are those of the program.
[[noreturn]] void become_bench(std::vector<std::string> words) {
    std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    program.replace_filename("relief-bench");
    const std::string file = program.string();
    words.insert(words.begin(), file);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(file.c_str(), arguments.data());
    throw Error(ErrorKind::failed,
                {fmt::format("the program of the measurements cannot be started: {}", std::strerror(errno)),
                 file, "build the target relief-bench, and install it beside relief"});
}

} // namespace

Command add_bench(CLI::App& verb) {
    verb.set_help_flag(), verb.set_help_all_flag(); // relief-bench handles both
    verb.prefix_command();
    return [&verb]() -> int { become_bench(verb.remaining()); };
}

} // namespace relief::cli
