// farm work.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/values.h"
#include "farm/farm_commands.h"
#include "farm/work_task.h"
#include "relief/error.h"
#include "relief/render.h"

namespace relief::cli {

namespace {

struct WorkArguments {
    std::string folder, tasks;
    WorkOptions work;
};

int run_work(const WorkArguments& arguments) {
    const FarmJob job = read_job(arguments.folder);
    if (arguments.tasks.empty())
        throw Error(ErrorKind::usage, {"no task given", "--task", "relief farm work JOB --task 0"});
    return work_on_tasks(job, parse_tasks(job, arguments.tasks), arguments.work);
}

} // namespace

Command add_farm_work(CLI::App& verb) {
    const auto arguments = std::make_shared<WorkArguments>();
    add_job_argument(verb, arguments->folder);
    verb.add_option("--task", arguments->tasks, "number of the task, from 0; or several: 0-7,12")
        ->type_name("I");
    verb.add_option_function<std::string>(
            "--threads",
            [arguments](const std::string& text) {
                arguments->work.threads = int(parse_integer("--threads", text, 0, kMaxThreads));
            },
            "0: as the job says (default)")
        ->type_name("N");
    verb.add_flag("--log", arguments->work.is_logged, "print to JOB/log in place of the terminal");
    verb.add_flag("-q", arguments->work.is_quiet, "no progress, no warnings on stderr");
    verb.add_flag("--again", arguments->work.is_repeated, "also tasks that are done");
    return [arguments] { return run_work(*arguments); };
}

} // namespace relief::cli
