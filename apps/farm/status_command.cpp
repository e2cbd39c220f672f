// farm status.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/report.h"
#include "farm/farm_commands.h"
#include "farm/sheet.h"
#include "farm/status_report.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

struct StatusOptions {
    std::string folder, sheet;
    bool is_watched = false, is_json = false, is_quiet = false;
};

void print_status(const FarmJob& job, const StatusReport& report, const StatusOptions& options) {
    constexpr const char* kClear = "\033[H\033[2J";
    if (options.is_json)
        print_output("{}", options.is_watched ? write_json(describe_status(job, report)) + "\n"
                                              : write_json(describe_status(job, report), 2));
    else
        print_output("{}{}", options.is_watched && ::isatty(STDOUT_FILENO) ? kClear : "",
                     format_status(job, report, options.is_quiet ? StatusDetail::counts : StatusDetail::all));
}

/// In short steps, so that an interrupt ends it soon.
void wait_a_while() {
    for (int step = 0; step < 8 && get_interrupt() == 0; ++step)
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
}

int run_status(const StatusOptions& options) {
    const FarmJob job = read_job(options.folder);
    if (!options.sheet.empty()) check_writable(options.sheet);
    StatusReport report = make_status(job);
    print_status(job, report, options);
    if (options.is_watched) catch_interrupts(), poll_interrupts();
    while (flush_output() && options.is_watched && !report.is_complete() && get_interrupt() == 0) {
        wait_a_while();
        report = make_status(job);
        print_status(job, report, options);
    }
    if (options.sheet.empty()) return kExitDone;
    write_image(make_sheet(job, report.states), options.sheet);
    if (!options.is_quiet) print_error("wrote {}\n", options.sheet);
    return kExitDone;
}

} // namespace

Command add_farm_status(CLI::App& verb) {
    const auto options = std::make_shared<StatusOptions>();
    add_job_argument(verb, options->folder);
    verb.add_flag("--watch", options->is_watched, "again every two seconds, until all frames are written");
    verb.add_flag("--json", options->is_json, "print a JSON object; with --watch one a line");
    verb.add_flag("-q", options->is_quiet, "only the counts of tasks and frames");
    verb.add_option("--sheet", options->sheet, "picture of what is there: small frames side by side")
        ->type_name("FILE");
    return [options] { return run_status(*options); };
}

} // namespace relief::cli
