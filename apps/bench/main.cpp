// relief-bench: the benchmark suites. Users start it as `relief bench`.
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/bench_options.h"
#include "bench/charts.h"
#include "bench/suites.h"
#include "common/command_line.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

void print_goals(const Value& goals) {
    for (const auto& goal : goals)
        print_output("{}  {}: {:.4g} {}, goal {:.4g}\n", goal["met"].get<bool>() ? "met    " : "not met",
                     goal["name"].get<std::string>(), goal["reached"].get<double>(),
                     goal["unit"].get<std::string>(), goal["goal"].get<double>());
}

int run_bench(const BenchOptions& options) {
    refuse_options_of_others(find_suite(options.suite), options);
    const std::filesystem::path folder =
        options.folder.empty() ? std::filesystem::path(options.suite) : options.folder;
    std::filesystem::create_directories(folder);
    check_text_writable(folder / (options.suite + ".json"));
    cli::WorkProgress progress(options.progress);
    const Report report = [&](const std::string& line) { progress.begin_step(line); };
    const SuiteResult outcome = run_suite(options, report);
    progress.end_line();
    for (const ReportFile& file : outcome.files) {
        write_text_file(folder / file.name, file.text);
        print_output("wrote {}\n", (folder / file.name).string());
    }
    report("drawing charts");
    const DrawnCharts charts = draw_charts(folder / outcome.files.front().name);
    progress.end_line();
    for (const std::string& line : charts.lines) print_output("{}\n", line);
    if (!charts.failure.empty()) print_error("relief bench: {}\n", charts.failure);
    if (!options.is_quick) print_goals(outcome.result["goals"]); // tiny pictures reach none
    return cli::kExitDone;
}

int parse_and_run(int argument_count, const char* const* arguments) {
    CLI::App app(kBenchDescription, "relief bench");
    cli::prepare_parsing(app);
    BenchOptions options;
    add_bench_options(app, options);
    if (const auto answered = cli::parse_words(app, argument_count, arguments)) return *answered;
    cli::refuse_extras(app, "relief bench");
    cli::refuse_empty_names(app);
    cli::complete_engine_options(options.engine, options.settings);
    return run_bench(options);
}

} // namespace

} // namespace relief::bench

int main(int argument_count, char** arguments) {
    if (const auto read = relief::run_mesh_reader(argument_count, arguments)) return *read;
    return relief::cli::run_program([&] { return relief::bench::parse_and_run(argument_count, arguments); });
}
