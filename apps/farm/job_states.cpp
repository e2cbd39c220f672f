#include "farm/job_states.h"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>

#include <dirent.h>

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

/// Collects the attempts of all folders.
class StateReader {
  public:
    explicit StateReader(const FarmJob& job) : job_(job) {
        states_.tasks.resize(job.task_count(), TaskState::waiting);
        done_counts_.resize(job.task_count());
    }

    JobStates read() {
        // By what is there, which may be less than what there could be.
        visit_names(job_.folder / "state", [&](const char* chunk) {
            if (chunk[0] == '.') return;
            ++states_.folders_read;
            visit_names(job_.folder / "state" / chunk, [&](const char* name) { add_name(name); });
        });
        judge_running();
        const auto is_other = [&](TaskState state) {
            return [this, state](const Attempt& attempt) { return states_.tasks[attempt.task] != state; };
        };
        std::erase_if(states_.running, is_other(TaskState::running));
        std::erase_if(states_.stale, is_other(TaskState::stale));
        std::erase_if(states_.failed, is_other(TaskState::failed));
        states_.twice = size_t(std::ranges::count_if(done_counts_, [](uint32_t count) { return count > 1; }));
        for (std::vector<Attempt>* attempts : {&states_.running, &states_.stale, &states_.failed})
            std::ranges::sort(*attempts, {}, &Attempt::task);
        return std::move(states_);
    }

  private:
    /// readdir alone: a directory_iterator may ask for the type of each file.
    template <class Visit> void visit_names(const fs::path& folder, const Visit& visit) {
        const std::unique_ptr<DIR, int (*)(DIR*)> opened(::opendir(folder.c_str()), ::closedir);
        if (!opened) return;
        while (const dirent* entry = ::readdir(opened.get())) visit(entry->d_name);
    }

    void add_name(const char* name) {
        if (name[0] == '.') return;
        ++states_.names_read;
        const std::optional<Attempt> attempt = parse_attempt_name(name);
        if (attempt && attempt->task < states_.tasks.size()) add(*attempt);
    }

    void add(const Attempt& attempt) {
        switch (attempt.state) {
        case AttemptState::running:
            said_to_run_.push_back(attempt);
            return;
        case AttemptState::done:
            ++states_.done_attempts, ++done_counts_[attempt.task];
            states_.rays += attempt.rays, states_.seconds += 1e-3 * double(attempt.milliseconds);
            return raise(attempt.task, TaskState::done);
        case AttemptState::partial:
            ++states_.partial;
            return raise(attempt.task, TaskState::partial);
        case AttemptState::failed:
            states_.failed.push_back(attempt);
            return raise(attempt.task, TaskState::failed);
        case AttemptState::lost:
            ++states_.lost;
            return;
        case AttemptState::corrupt:
            ++states_.corrupt;
            return;
        case AttemptState::retried:
            ++states_.retried;
        }
    }

    void raise(uint32_t task, TaskState state) { states_.tasks[task] = std::max(states_.tasks[task], state); }

    void judge_running() {
        if (said_to_run_.empty()) return;
        const double now_s = read_storage_clock(job_);
        for (Attempt& attempt : said_to_run_) {
            ++states_.files_looked_at;
            const std::optional<double> silence_s = measure_silence(job_, attempt, now_s);
            if (!silence_s) continue; // it has just ended
            const bool is_dead = is_stale(job_, attempt, *silence_s);
            raise(attempt.task, is_dead ? TaskState::stale : TaskState::running);
            (is_dead ? states_.stale : states_.running).push_back(std::move(attempt));
        }
    }

    const FarmJob& job_;
    JobStates states_;
    std::vector<Attempt> said_to_run_;
    std::vector<uint32_t> done_counts_; ///< attempts that are done, a task
};

} // namespace

size_t JobStates::count(TaskState state) const { return size_t(std::ranges::count(tasks, state)); }

bool JobStates::is_frame_done(const FarmJob& job, size_t frame_index) const {
    const auto first = tasks.begin() + ptrdiff_t(frame_index * job.tasks_a_frame());
    return std::all_of(first, first + ptrdiff_t(job.tasks_a_frame()),
                       [](TaskState state) { return state == TaskState::done; });
}

JobStates read_states(const FarmJob& job) { return StateReader(job).read(); }

std::vector<uint32_t> list_tasks(const JobStates& states, std::initializer_list<TaskState> wanted) {
    std::vector<uint32_t> tasks;
    for (uint32_t task = 0; task < states.tasks.size(); ++task)
        if (std::ranges::find(wanted, states.tasks[task]) != wanted.end()) tasks.push_back(task);
    return tasks;
}

void declare_lost(const FarmJob& job, const std::vector<Attempt>& attempts) {
    for (const Attempt& attempt : attempts) declare_dead(job, attempt);
}

} // namespace relief::cli
