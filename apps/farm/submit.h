// Hands the tasks of a job to what runs them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/progress.h"
#include "farm/job.h"

namespace relief::cli {

enum class SubmitTarget { local, slurm, openjd };
enum class MergeStep { with, without };

struct SubmitOptions {
    SubmitTarget target = SubmitTarget::local;
    MergeStep merge = MergeStep::with; ///< frames are written when all tasks have ended
    int threads = 0;                   ///< of one task; 0: a share of this machine, and 1 on a cluster
    int workers = 0;                   ///< local: processes at once; 0: one for each four processors
    int attempts = 3;                  ///< local: at a task whose process is killed
    size_t group = 0;                  ///< clusters: tasks of one element; 0: as few as their limits allow
    std::vector<std::string> sbatch;   ///< further options of sbatch, as it takes them
    ProgressOptions progress;
};

/// Processes of this machine, until all tasks have ended; returns the exit code of the command. An interrupt
/// is passed on to them, and the samples so far are kept.
int run_locally(const FarmJob& job, const std::vector<uint32_t>& tasks, const SubmitOptions& options);

/// Array jobs of Slurm by sbatch, as many as its MaxArraySize asks for, and a job behind them that writes the
/// frames. Throws Error{failed} where its commands are missing or refuse.
int submit_to_slurm(const FarmJob& job, const std::vector<uint32_t>& tasks, const SubmitOptions& options);

/// Writes an Open Job Description template.
int write_openjd_template(const FarmJob& job, const std::vector<uint32_t>& tasks,
                          const SubmitOptions& options);

} // namespace relief::cli
