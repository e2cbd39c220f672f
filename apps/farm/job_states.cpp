#include "farm/job_states.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "farm/folder_names.h"
#include "farm/job_file.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

/// Folders that are read at once, whatever the number of processors: they wait for the storage, which answers
/// many as soon as one. Of 4, 8, 16 and 32 this was the least that was fastest with an empty cache.
constexpr size_t kReaders = 16;

/// The attempts of one folder.
std::vector<Attempt> read_folder(const fs::path& folder, size_t& names_read) {
    std::vector<Attempt> attempts;
    visit_names(folder, [&](const char* name) {
        ++names_read;
        if (std::optional<Attempt> attempt = parse_attempt_name(name))
            attempts.push_back(*std::move(attempt));
    });
    return attempts;
}

/// Collects the attempts of all folders.
class StateReader {
  public:
    explicit StateReader(const FarmJob& job) : job_(job) {
        states_.tasks.resize(job.task_count(), TaskState::waiting);
        done_counts_.resize(job.task_count());
    }

    JobStates read() {
        read_folders();
        judge_running();
        const auto is_other = [&](TaskState state) {
            return [this, state](const Attempt& attempt) { return states_.tasks[attempt.task] != state; };
        };
        std::erase_if(states_.running, is_other(TaskState::running));
        std::erase_if(states_.stale, is_other(TaskState::stale));
        std::erase_if(states_.failed, is_other(TaskState::failed));
        states_.twice = size_t(std::ranges::count_if(done_counts_, [](uint32_t count) { return count > 1; }));
        for (std::vector<Attempt>* attempts : {&states_.running, &states_.stale, &states_.failed})
            std::ranges::sort(*attempts, {}, [](const Attempt& a) { return std::tie(a.task, a.who); });
        states_.seconds = 1e-3 * double(milliseconds_);
        return std::move(states_);
    }

  private:
    /// By what is there, which may be less than what there could be.
    void read_folders() {
        std::vector<fs::path> folders;
        const fs::path root = job_.folder / "state";
        check_job_file(job_, root);
        visit_names(root, [&](const char* name) { folders.push_back(root / name); });
        for (const fs::path& folder : folders) check_job_file(job_, folder);
        states_.folders_read = folders.size();
        std::atomic<size_t> next = 0;
        const auto read_some = [&] {
            for (size_t k = next++; k < folders.size(); k = next++) {
                size_t names_read = 0;
                const std::vector<Attempt> attempts = read_folder(folders[k], names_read);
                const std::scoped_lock lock(mutex_);
                states_.names_read += names_read;
                for (const Attempt& attempt : attempts) add(attempt);
            }
        };
        std::vector<std::future<void>> readers;
        try {
            for (size_t k = 1; k < std::min(kReaders, folders.size()); ++k)
                readers.push_back(std::async(std::launch::async, read_some));
        } catch (const std::system_error&) { // threads are limited here: those that there are read all
        }
        read_some();
        for (std::future<void>& reader : readers) reader.get();
    }

    /// In any order: the result does not depend on it.
    void add(const Attempt& attempt) {
        if (attempt.task >= states_.tasks.size()) return;
        switch (attempt.state) {
        case AttemptState::running:
            said_to_run_.push_back(attempt);
            return;
        case AttemptState::done:
            ++states_.done_attempts, ++done_counts_[attempt.task];
            states_.rays += attempt.rays, milliseconds_ += attempt.milliseconds;
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
    std::mutex mutex_; ///< of all below
    JobStates states_;
    uint64_t milliseconds_ = 0; ///< of attempts that are done
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
