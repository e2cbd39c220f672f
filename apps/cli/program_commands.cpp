// bench and view: forward their arguments to relief-bench and relief-view, which are built and installed
// separately. Their help is here as well.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "bench/bench_options.h"
#include "bench/suite_list.h"
#include "commands.h"
#include "common/command_line.h"
#include "relief/error.h"
#include "viewer/viewer_options.h"

namespace relief::cli {

namespace {

/// A program beside this one.
struct Program {
    const char *name, *command, *description;
    void (*add_options)(CLI::App& app);
    const char* hint; ///< where the program is missing
};

void add_options_of_bench(CLI::App& app) {
    const auto options = std::make_shared<bench::BenchOptions>();
    bench::add_bench_options(app, *options);
    app.final_callback([options] {}); // keeps them as long as the app
}

void add_options_of_view(CLI::App& app) {
    const auto options = std::make_shared<viewer::ViewerOptions>();
    viewer::add_viewer_options(app, *options);
    app.final_callback([options] {});
}

/// Prints the help or the version of a program, neither of which needs the program. Returns nullopt if the
/// words ask for something else.
std::optional<int> answer_without(const Program& program, const std::vector<std::string>& words) {
    CLI::App app(program.description, program.command);
    prepare_parsing(app);
    program.add_options(app);
    std::vector<const char*> arguments = {program.command};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    try {
        return parse_words(app, int(arguments.size()), arguments.data());
    } catch (const Error&) {
        return std::nullopt; // that the program is missing comes first
    }
}

/// Replaces this process (exec) by the program, so that exit code, signals and terminal are those of it.
int become_program(const Program& program, std::vector<std::string> words) {
    std::filesystem::path place = std::filesystem::read_symlink("/proc/self/exe");
    place.replace_filename(program.name);
    const std::string file = place.string();
    words.insert(words.begin(), file);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(file.c_str(), arguments.data());
    const int code = errno;
    words.erase(words.begin());
    if (const std::optional<int> answered = answer_without(program, words)) return *answered;
    throw Error(ErrorKind::failed,
                {fmt::format("the program of this command cannot be started: {}", std::strerror(code)), file,
                 program.hint});
}

Command add_program(CLI::App& verb, const Program& program) {
    verb.set_help_flag(), verb.set_help_all_flag(); // the program handles both
    verb.prefix_command();
    return [&verb, program] { return become_program(program, verb.remaining()); };
}

} // namespace

Command add_bench(CLI::App& verb) {
    return add_program(verb, {"relief-bench", "relief bench", bench::kBenchDescription, add_options_of_bench,
                              "build the target relief-bench, and install it beside relief"});
}

Command add_view(CLI::App& verb) {
    return add_program(verb,
                       {"relief-view", "relief view", viewer::kViewerDescription, add_options_of_view,
                        "build the target relief-view (-DRELIEF_VIEWER=ON), and install it beside relief"});
}

} // namespace relief::cli
