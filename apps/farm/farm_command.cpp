#include "farm/farm_command.h"

#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/option_hints.h"
#include "farm/farm_commands.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

struct FarmVerb {
    CLI::App* app;
    Command command;
};

int run_farm(const CLI::App& farm, const std::vector<FarmVerb>& verbs) {
    for (const FarmVerb& verb : verbs) {
        if (!verb.app->parsed()) continue;
        refuse_extras(*verb.app, "relief farm " + verb.app->get_name());
        refuse_empty_names(*verb.app);
        return verb.command();
    }
    const std::vector<std::string> extras = farm.remaining();
    const std::string help = "relief farm --help lists what there is";
    if (extras.empty()) throw Error(ErrorKind::usage, {"farm does what?", "", help});
    std::vector<std::string_view> names;
    for (const FarmVerb& verb : verbs) names.push_back(verb.app->get_name());
    const std::string hint = suggest_command(extras.front(), names);
    throw Error(ErrorKind::usage,
                {fmt::format("farm has no '{}'", extras.front()), "", hint.empty() ? help : hint});
}

} // namespace

void add_job_argument(CLI::App& verb, std::string& folder) {
    verb.add_option("job", folder, "folder that relief farm plan wrote")->type_name("JOB");
}

Command add_farm(CLI::App& farm) {
    std::vector<FarmVerb> verbs;
    const auto add = [&](const char* name, const char* description, Command (*add_options)(CLI::App&)) {
        CLI::App* verb = farm.add_subcommand(name, description);
        verb->allow_extras();
        verbs.push_back({verb, add_options(*verb)});
    };
    add("plan", "Cut a shot into tasks: frame x tile x range of samples", add_farm_plan);
    add("submit", "Hand the tasks to processes of this machine, to Slurm or to OpenJD", add_farm_submit);
    add("work", "Render tasks of a job: what a node runs", add_farm_work);
    add("status", "Tell what is done, running, failed and left", add_farm_status);
    add("merge", "Write the frames that are complete, and tell what is missing", add_farm_merge);
    add("retry", "Put up failed, stale and partial tasks again", add_farm_retry);
    return [&farm, verbs] { return run_farm(farm, verbs); };
}

} // namespace relief::cli
