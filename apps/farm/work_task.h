// What a machine of the farm does: renders tasks of a job.
#pragma once

#include <string>
#include <vector>

#include "farm/job.h"

namespace relief::cli {

struct WorkOptions {
    int threads = 0;          ///< 0: as the job says
    bool is_logged = false;   ///< what is printed goes to the log of the task
    bool is_quiet = false;    ///< without progress and warnings, whatever the job says
    bool is_repeated = false; ///< tasks that are done are rendered again
};

/// Renders tasks one after another; returns the exit code of the first that did not end well, as `relief
/// render` has it. Throws Error.
int work_on_tasks(const FarmJob& job, const std::vector<uint32_t>& tasks, const WorkOptions& options);

} // namespace relief::cli
