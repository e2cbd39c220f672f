// Cuts a shot into tasks, and writes their job folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/render_options.h"
#include "farm/job.h"

namespace relief::cli {

struct PlanOptions {
    RenderOptions render;           ///< `input`, `frames` and what all tasks share
    std::vector<std::string> words; ///< the latter as they were given
    std::filesystem::path folder;   ///< of the job
    std::filesystem::path pictures; ///< empty: in the job folder
    int tiles = 1, passes = 1;
    double heartbeat_s = 10;
};

/// Reads and hashes all files of all frames, measures what the first frame costs and prints its warnings, and
/// writes the manifest. nullopt: there are warnings, and --strict was given. Of a plan that fails nothing is
/// left. Throws Error: usage where the folder is there already, bad_input for a file of any frame that is
/// missing, failed where the folder cannot be written.
std::optional<FarmJob> plan_job(PlanOptions options);

} // namespace relief::cli
