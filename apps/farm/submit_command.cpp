// farm submit and farm retry.
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "common/values.h"
#include "farm/farm_commands.h"
#include "farm/job_states.h"
#include "farm/submit.h"
#include "relief/error.h"
#include "relief/render.h"

namespace relief::cli {

namespace {

struct SubmitArguments {
    std::string folder;
    SubmitOptions submit;
    std::vector<std::string> cluster_only, local_only; ///< given options that only these take
    bool leaves_merge = false;
    std::optional<SubmitTarget> target; ///< of retry; nullopt: nothing is submitted
};

constexpr std::array<std::pair<std::string_view, SubmitTarget>, 3> kTargets{
    {{"local", SubmitTarget::local}, {"slurm", SubmitTarget::slurm}, {"openjd", SubmitTarget::openjd}}};

CLI::Option* add_text(CLI::App& verb, const std::string& name, const char* value, const std::string& help,
                      std::function<void(const std::string&)> parse) {
    return verb.add_option_function<std::string>(name, std::move(parse), help)->type_name(value);
}

void add_local_options(CLI::App& verb, SubmitArguments& a) {
    add_text(verb, "--workers", "N", "local: processes at once; default: one for four processors",
             [&a](const std::string& text) {
                 a.submit.workers = int(parse_integer("--workers", text, 1, 1024));
                 a.local_only.emplace_back("--workers");
             });
    add_text(verb, "--attempts", "N", "local: at a task whose process is killed; default 3",
             [&a](const std::string& text) {
                 a.submit.attempts = int(parse_integer("--attempts", text, 1, 1000));
                 a.local_only.emplace_back("--attempts");
             });
}

void add_cluster_options(CLI::App& verb, SubmitArguments& a) {
    add_text(verb, "--group", "N", "slurm, openjd: tasks of one element; default: as few as limits allow",
             [&a](const std::string& text) {
                 a.submit.group = size_t(parse_integer("--group", text, 1, 1'000'000));
                 a.cluster_only.emplace_back("--group");
             });
    const auto pass_on = [&](const char* name, const char* value, const std::string& help) {
        add_text(verb, name, value, help, [&a, name](const std::string& text) {
            a.submit.sbatch.push_back(fmt::format("{}={}", name, text));
        });
    };
    pass_on("--partition", "NAME", "slurm: of sbatch");
    pass_on("--account", "NAME", "slurm: of sbatch");
    verb.add_option("--sbatch", a.submit.sbatch,
                    "slurm: any option of sbatch: --sbatch=--nice=100; takes the place of ours")
        ->type_name("OPTION")
        ->take_all();
}

void add_submit_options(CLI::App& verb, SubmitArguments& a) {
    add_job_argument(verb, a.folder);
    add_text(verb, "--threads", "N", "of one task; default: a share of this machine, 1 on a cluster",
             [&a](const std::string& text) {
                 a.submit.threads = int(parse_integer("--threads", text, 1, kMaxThreads));
             });
    verb.add_flag("--no-merge", a.leaves_merge, "leave the frames to relief farm merge");
    add_local_options(verb, a), add_cluster_options(verb, a);
    add_progress_options(verb, a.submit.progress, "no progress on stderr");
}

void refuse_foreign_options(const SubmitArguments& a) {
    const auto refuse = [](const std::string& option, const char* target) {
        throw Error(ErrorKind::usage, {fmt::format("it goes with --to {}", target), option,
                                       "relief farm submit --help tells what goes with what"});
    };
    const SubmitTarget target = a.submit.target;
    if (target != SubmitTarget::local && !a.local_only.empty()) refuse(a.local_only.front(), "local");
    if (target == SubmitTarget::local && !a.cluster_only.empty())
        refuse(a.cluster_only.front(), "slurm, or --to openjd");
    if (target != SubmitTarget::slurm && !a.submit.sbatch.empty()) refuse(a.submit.sbatch.front(), "slurm");
}

int submit_tasks(const FarmJob& job, const std::vector<uint32_t>& tasks, SubmitArguments& a) {
    a.submit.merge = a.leaves_merge ? MergeStep::without : MergeStep::with;
    if (a.submit.target == SubmitTarget::local) return run_locally(job, tasks, a.submit);
    if (tasks.empty()) {
        print_output("nothing is left to be rendered; relief farm merge {} writes the frames\n",
                     job.folder.string());
        return kExitDone;
    }
    return a.submit.target == SubmitTarget::slurm ? submit_to_slurm(job, tasks, a.submit)
                                                  : write_openjd_template(job, tasks, a.submit);
}

/// Tasks that have failed, or may still run somewhere, are left to `retry`.
int run_submit(SubmitArguments& a) {
    refuse_foreign_options(a);
    const FarmJob job = read_job(a.folder);
    check_version(job);
    const JobStates states = read_states(job);
    for (const auto& [state, what] :
         {std::pair(TaskState::failed, "have failed"), std::pair(TaskState::stale, "show no sign of life")})
        if (const size_t count = states.count(state); count > 0)
            print_error("relief: warning: {} tasks {}: relief farm retry {} puts them up again\n", count,
                        what, job.folder.string());
    return submit_tasks(job, list_tasks(states, {TaskState::waiting, TaskState::partial}), a);
}

/// Failures become waiting tasks again; what they were stays in the names of their attempts.
void forget_failures(const FarmJob& job, const JobStates& states) {
    for (const Attempt& attempt : states.failed) {
        Attempt retried = attempt;
        retried.state = AttemptState::retried;
        change_attempt(job, attempt, retried);
    }
    for (size_t frame = 0; frame < job.frames.size(); ++frame)
        if (!states.is_frame_done(job, frame)) forget_written_frame(job, frame);
}

int run_retry(SubmitArguments& a) {
    if (a.target) a.submit.target = *a.target, refuse_foreign_options(a);
    const FarmJob job = read_job(a.folder);
    check_version(job);
    const JobStates states = read_states(job);
    forget_failures(job, states);
    declare_lost(job, states.stale);
    const std::vector<uint32_t> again =
        list_tasks(states, {TaskState::failed, TaskState::stale, TaskState::partial});
    print_output("put up again: {} failed, {} stale and {} partial tasks{}{}\n",
                 states.count(TaskState::failed), states.count(TaskState::stale),
                 states.count(TaskState::partial), again.empty() ? "" : ": ", format_tasks(again));
    if (!a.target) {
        print_output("relief farm submit {} renders them\n", job.folder.string());
        return kExitDone;
    }
    return submit_tasks(job, list_tasks(read_states(job), {TaskState::waiting, TaskState::partial}), a);
}

} // namespace

Command add_farm_submit(CLI::App& verb) {
    const auto arguments = std::make_shared<SubmitArguments>();
    add_submit_options(verb, *arguments);
    add_text(verb, "--to", "NAME", "local (default), slurm, openjd", [arguments](const std::string& text) {
        arguments->submit.target = parse_word("--to", text, kTargets);
    });
    return [arguments] { return run_submit(*arguments); };
}

Command add_farm_retry(CLI::App& verb) {
    const auto arguments = std::make_shared<SubmitArguments>();
    add_submit_options(verb, *arguments);
    add_text(
        verb, "--submit", "NAME", "and submit all that is left: local, slurm, openjd",
        [arguments](const std::string& text) { arguments->target = parse_word("--submit", text, kTargets); });
    return [arguments] { return run_retry(*arguments); };
}

} // namespace relief::cli
