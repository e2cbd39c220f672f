// farm plan.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "common/values.h"
#include "farm/farm_commands.h"
#include "farm/plan_job.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

/// Options of `render` that are of one picture, or that say which part of it is rendered.
constexpr std::array<const char*, 12> kForeign = {
    "-o",          "--tile",       "--samples", "--edits",      "--pixel",  "--stats",
    "--turntable", "--save-scene", "--noise",   "--time-limit", "--resume", "--skip-existing"};
/// Options that are of the plan, not of its tasks.
constexpr std::array<std::string_view, 8> kOwn = {"--tiles",  "--passes",   "--pictures", "--heartbeat",
                                                  "--frames", "--progress", "--help",     "--help-all"};

template <class Parse>
void add_value(CLI::App& verb, const std::string& name, const char* value, const std::string& help,
               Parse parse) {
    verb.add_option_function<std::string>(name, parse, help)->type_name(value);
}

/// The options of `render` that were given, as words.
std::vector<std::string> collect_words(const CLI::App& verb) {
    std::vector<std::string> words;
    for (const CLI::Option* option : verb.get_options()) {
        const std::string name = option->get_name();
        const bool is_own = std::ranges::find(kOwn, name) != kOwn.end() || name == "-o" || name == "-q";
        if (option->count() == 0 || is_own || !name.starts_with("-")) continue;
        if (option->get_items_expected_max() == 0) {
            words.push_back(name);
            continue;
        }
        // One word: a value may begin with a dash.
        for (const std::string& value : option->results()) words.push_back(fmt::format("{}={}", name, value));
    }
    return words;
}

int run_plan(PlanOptions& options, const CLI::App& verb) {
    if (options.folder.empty())
        throw Error(ErrorKind::usage, {"no job folder given", "", "relief farm plan SCENE.json -o JOB"});
    options.words = collect_words(verb);
    const std::optional<FarmJob> planned = plan_job(std::move(options));
    if (!planned) return kExitWarnings;
    const FarmJob& job = *planned;
    const JobEstimate& e = job.estimate;
    print_output("planned {} tasks: {} frames x {} tiles x {} ranges of samples, {} files\n",
                 job.task_count(), job.frames.size(), job.tiles, job.passes, job.files.size());
    const double task_s = e.ready_s + e.frame_s / double(job.tasks_a_frame());
    print_output("a task takes about {:.3g} s, {:.2g} s of it to be ready, with {} threads, and {:.0f} MB\n",
                 task_s, e.ready_s, e.threads, 1e-6 * double(e.memory_bytes));
    print_output("relief farm submit {} renders it\n", job.folder.string());
    return kExitDone;
}

} // namespace

Command add_farm_plan(CLI::App& verb) {
    const auto options = std::make_shared<PlanOptions>();
    add_render_options(verb, options->render);
    for (const char* name : kForeign) verb.remove_option(verb.get_option(name));
    add_value(verb, "-o", "JOB", "job folder, which is made",
              [options](const std::string& text) { options->folder = text; });
    add_value(verb, "--tiles", "N", "bands of rows a frame; default 1", [options](const std::string& text) {
        options->tiles = int(parse_integer("--tiles", text, 1, kMostTiles));
    });
    add_value(verb, "--passes", "M", "ranges of samples a frame; default 1",
              [options](const std::string& text) {
                  options->passes = int(parse_integer("--passes", text, 1, kMostPasses));
              });
    add_value(verb, "--pictures", "FILE", "of the frames: OUT.####.exr; default: in JOB/frames",
              [options](const std::string& text) { options->pictures = text; });
    add_value(verb, "--heartbeat", "S", "a task that is silent for six times as long is dead; default 10",
              [options](const std::string& text) {
                  options->heartbeat_s =
                      parse_number("--heartbeat", text, kLeastHeartbeat_s, kMostHeartbeat_s);
              });
    return [options, &verb] { return run_plan(*options, verb); };
}

} // namespace relief::cli
