// Where all tasks of a job are, from names of files alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "farm/attempts.h"
#include "farm/job.h"

namespace relief::cli {

/// In rising order of what counts where attempts differ.
enum class TaskState : uint8_t {
    waiting, ///< no attempt, or lost ones only
    partial,
    failed,
    stale, ///< said to be running, without a sign of life
    running,
    done
};

struct JobStates {
    std::vector<TaskState> tasks;
    std::vector<Attempt> running, stale, failed;            ///< attempts at tasks in that state
    size_t lost = 0, corrupt = 0, partial = 0, retried = 0; ///< attempts of these kinds, ever
    size_t twice = 0;                                       ///< tasks that were done more than once
    size_t done_attempts = 0;
    uint64_t rays = 0;  ///< of attempts that are done
    double seconds = 0; ///< likewise, each from its start to its end
    size_t folders_read = 0, names_read = 0, files_looked_at = 0; ///< what it took to know

    size_t count(TaskState state) const;
    bool is_frame_done(const FarmJob& job, size_t frame_index) const;
};

/// Reads one folder for each thousand tasks, and the times of running attempts' files; no other file is
/// opened or looked at.
JobStates read_states(const FarmJob& job);

/// Tasks in one of these states, in rising order.
std::vector<uint32_t> list_tasks(const JobStates& states, std::initializer_list<TaskState> wanted);

/// Attempts that ended without a word become lost.
void declare_lost(const FarmJob& job, const std::vector<Attempt>& attempts);

} // namespace relief::cli
