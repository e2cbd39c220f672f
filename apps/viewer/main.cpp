#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/command_line.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/interface.h"
#include "viewer/serve.h"
#include "viewer/signals.h"
#include "viewer/viewer_options.h"

namespace relief::viewer {

namespace {

/// Of a window whose picture has no size of its own.
constexpr int kWindowWidth = 1240, kWindowHeight = 720;

int run_viewer(const ViewerOptions& options, double start) {
    std::vector<ScriptLine> lines;
    if (!options.script.empty()) {
        std::ifstream file(options.script);
        lines = read_script(file, options.script.string());
    }
    std::optional<std::pair<int, int>> size;
    if (options.given.width) size.emplace(*options.given.width, *options.given.height);
    // A script leaves no traces.
    Workbench workbench(options.settings, options.given, Window::wake,
                        options.script.empty() ? find_state_folder() : std::filesystem::path());
    // Files are read while the window opens.
    if (!options.input.file.empty()) workbench.open(options.input);
    Window window(size ? size->first + Interface::kPanelWidth : kWindowWidth,
                  size ? size->second + Interface::kLineHeight : kWindowHeight, "Relief");
    Interface interface(window, workbench, size);
    note_signals();
    const auto end = [&] {
        workbench.refuse_nothing_open(); // said on the terminal too
        return get_signal() != 0 ? cli::kExitSignalBase + get_signal() : cli::kExitDone;
    };
    if (options.script.empty()) {
        interface.run(nullptr, start);
        return end();
    }
    ScriptRunner script(std::move(lines), options.script.string(), workbench, interface.view(),
                        {[&](const InputEvent& event) { window.inject(event); },
                         [&](const std::filesystem::path& file) { window.take_screenshot(file); },
                         [&](const std::string& line) {
                             if (!options.is_quiet) print_output("{}\n", line), flush_output();
                         }});
    interface.run(&script, start);
    return end();
}

} // namespace
} // namespace relief::viewer

int main(int argument_count, char** arguments) {
    using namespace relief;
    // It starts itself to read files that a third-party library parses.
    if (const auto read = run_mesh_reader(argument_count, arguments)) return *read;
    const double start =
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    return cli::run_program([&] {
        CLI::App app(viewer::kViewerDescription, "relief view");
        cli::prepare_parsing(app);
        viewer::ViewerOptions options;
        viewer::add_viewer_options(app, options);
        if (const auto answered = cli::parse_words(app, argument_count, arguments)) return *answered;
        cli::refuse_extras(app, "relief view");
        cli::refuse_empty_names(app);
        viewer::complete_viewer_options(options);
        return options.port ? viewer::serve(options) : viewer::run_viewer(options, start);
    });
}
