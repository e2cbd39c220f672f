// farm merge.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/interrupt.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/values.h"
#include "farm/farm_commands.h"
#include "relief/error.h"
#include "relief/shot.h"

namespace relief::cli {

namespace {

constexpr size_t kMostFrames = 20; ///< that are named

void print_missing(const FarmJob& job, const MergeReport& report) {
    const JobStates states = read_states(job);
    for (size_t k = 0; k < std::min(report.missing.size(), kMostFrames); ++k) {
        const size_t index = report.missing[k];
        std::string missing = describe_missing(job, states, index);
        print_error("relief: warning: frame {} is not whole, missing: {}\n", job.frames[index],
                    missing.empty() ? "a part that has been put up again since" : missing);
    }
    if (report.missing.size() > kMostFrames)
        print_error("relief: warning: and {} more frames\n", report.missing.size() - kMostFrames);
}

} // namespace

int merge_and_report(const FarmJob& job, const MergeOptions& options) {
    const MergeReport report = merge_frames(job, options);
    print_output("wrote {} frames; {} were there already, {} are not whole\n", report.written, report.kept,
                 report.missing.size());
    if (get_interrupt() != 0) return report.exit_code;
    if (report.missing.empty()) return report.exit_code;
    print_missing(job, report);
    throw Error(
        ErrorKind::bad_input,
        {fmt::format("{} of {} frames are not whole", report.missing.size(), job.frames.size()),
         job.folder.string(),
         fmt::format(
             "relief farm status {0} tells why; relief farm retry {0} puts failed tasks up again, and "
             "relief farm submit {0} renders what is missing",
             job.folder.string())});
}

Command add_farm_merge(CLI::App& verb) {
    struct Arguments {
        std::string folder;
        MergeOptions merge;
    };
    const auto arguments = std::make_shared<Arguments>();
    add_job_argument(verb, arguments->folder);
    verb.add_option_function<std::string>(
            "--frames",
            [arguments](const std::string& text) { arguments->merge.frames = parse_frames(text); },
            "these alone: several machines can share the work")
        ->type_name("LIST");
    verb.add_option_function<std::string>(
            "--threads",
            [arguments](const std::string& text) {
                arguments->merge.threads = int(parse_integer("--threads", text, 0, kMaxThreads));
            },
            "0: as the job says (default)")
        ->type_name("N");
    verb.add_flag("--remove-parts", arguments->merge.removes_parts,
                  "of frames that are written: they take space");
    add_progress_options(verb, arguments->merge.progress, "no progress, no warnings on stderr");
    return [arguments] { return merge_and_report(read_job(arguments->folder), arguments->merge); };
}

} // namespace relief::cli
