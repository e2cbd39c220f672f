// What `farm status` tells.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/report.h"
#include "farm/job.h"
#include "farm/job_states.h"

namespace relief::cli {

struct FailedTask {
    Attempt attempt;
    std::string reason;                 ///< first line of the attempt's file; may be empty
    std::vector<std::string> log_lines; ///< the last ones
};

struct StatusReport {
    JobStates states;
    size_t frames_done = 0, frames_begun = 0, frames_written = 0;
    double rays_per_second = 0;     ///< of all that run now; where nothing runs, of one
    std::optional<double> left_s;   ///< nullopt: nothing was done yet, or nothing runs
    std::vector<FailedTask> failed; ///< a few of many
    bool is_complete() const { return frames_written > 0 && frames_written == frame_count; }
    size_t frame_count = 0;
};

StatusReport make_status(const FarmJob& job);

enum class StatusDetail { counts, all };

/// Lines for people.
std::string format_status(const FarmJob& job, const StatusReport& report, StatusDetail detail);
/// The same as one record; docs/farm.md lists its keys.
Value describe_status(const FarmJob& job, const StatusReport& report);

} // namespace relief::cli
