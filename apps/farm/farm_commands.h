// The verbs under `relief farm`: each adds its options to a subcommand and returns what runs it.
#pragma once

#include "common/command_line.h"
#include "farm/merge_frames.h"

namespace relief::cli {

Command add_farm_plan(CLI::App& verb);
Command add_farm_work(CLI::App& verb);
Command add_farm_submit(CLI::App& verb);
Command add_farm_status(CLI::App& verb);
Command add_farm_merge(CLI::App& verb);
Command add_farm_retry(CLI::App& verb);

/// Writes frames and tells what is missing; returns the exit code.
int merge_and_report(const FarmJob& job, const MergeOptions& options);

/// Adds the job folder, the first word behind the verb.
void add_job_argument(CLI::App& verb, std::string& folder);

} // namespace relief::cli
