// bench and view: forward their arguments to relief-bench and relief-view, which are built and installed
// separately.
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

/// Replaces this process (exec) by the program `name` beside it, so that exit code, signals and terminal are
/// those of the program.
[[noreturn]] void become_program(const std::string& name, std::vector<std::string> words, const char* hint) {
    std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    program.replace_filename(name);
    const std::string file = program.string();
    words.insert(words.begin(), file);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(file.c_str(), arguments.data());
    throw Error(
        ErrorKind::failed,
        {fmt::format("the program of this command cannot be started: {}", std::strerror(errno)), file, hint});
}

} // namespace

Command add_bench(CLI::App& verb) {
    verb.set_help_flag(), verb.set_help_all_flag(); // relief-bench handles both
    verb.prefix_command();
    return [&verb]() -> int {
        become_program("relief-bench", verb.remaining(),
                       "build the target relief-bench, and install it beside relief");
    };
}

Command add_view(CLI::App& verb) {
    verb.set_help_flag(), verb.set_help_all_flag(); // relief-view handles both
    verb.prefix_command();
    return [&verb]() -> int {
        become_program("relief-view", verb.remaining(),
                       "build the target relief-view (-DRELIEF_VIEWER=ON), and install it beside relief");
    };
}

} // namespace relief::cli
