#include "farm/farm_command.h"

#include <CLI/CLI.hpp>

#include "common/verbs.h"
#include "farm/farm_commands.h"

namespace relief::cli {

void add_job_argument(CLI::App& verb, std::string& folder) {
    verb.add_option("job", folder, "folder that relief farm plan wrote")->type_name("JOB");
}

Command add_farm(CLI::App& farm) {
    Verbs verbs(farm, "relief farm");
    verbs.add("plan", "Cut a shot into tasks: frame x tile x range of samples", add_farm_plan);
    verbs.add("submit", "Hand the tasks to processes of this machine, to Slurm or to OpenJD",
              add_farm_submit);
    verbs.add("work", "Render tasks of a job: what a node runs", add_farm_work);
    verbs.add("status", "Tell what is done, running, failed and left", add_farm_status);
    verbs.add("merge", "Write the frames that are complete, and tell what is missing", add_farm_merge);
    verbs.add("retry", "Put up failed, stale and partial tasks again", add_farm_retry);
    return [verbs] { return verbs.find()(); };
}

} // namespace relief::cli
