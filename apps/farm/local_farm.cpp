// farm submit --to local: worker processes of this machine.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <thread>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/interrupt.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/progress.h"
#include "farm/attempts.h"
#include "farm/farm_commands.h"
#include "farm/job_states.h"
#include "farm/submit.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

constexpr int kProcessorsAWorker = 4;
constexpr size_t kMostTold = 10; ///< failures

struct Worker {
    pid_t process = 0;
    uint32_t task = 0;
};

/// Starts `relief farm work` for one task; it gets a signal when this process ends.
pid_t start_worker(const FarmJob& job, uint32_t task, int threads) {
    std::vector<std::string> words = {"relief",    "farm",
                                      "work",      job.folder.string(),
                                      "--task",    std::to_string(task),
                                      "--threads", std::to_string(threads),
                                      "--log"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid(), process = ::fork();
    if (process < 0)
        throw Error(ErrorKind::failed, {fmt::format("no process can be started: {}", std::strerror(errno)),
                                        "--workers", "fewer workers"});
    if (process > 0) return process;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kExitSignalBase + SIGTERM);
    ::execv("/proc/self/exe", arguments.data());
    ::_exit(127);
}

/// All workers of one run.
class LocalFarm {
  public:
    LocalFarm(const FarmJob& job, const std::vector<uint32_t>& tasks, const SubmitOptions& options)
        : job_(job),
          options_(options),
          printer_(options.progress),
          waiting_(tasks.begin(), tasks.end()),
          attempts_(job.task_count()),
          count_(tasks.size()) {
        const int processors = std::max(1, int(std::thread::hardware_concurrency()));
        workers_wanted_ =
            options.workers > 0 ? options.workers : std::max(1, processors / kProcessorsAWorker);
        threads_ = options.threads > 0 ? options.threads : std::max(1, processors / workers_wanted_);
    }

    /// The exit code of the first task that failed, or of the interrupt.
    int run() {
        catch_interrupts(), poll_interrupts();
        while (!workers_.empty() || (!waiting_.empty() && get_interrupt() == 0)) {
            if (get_interrupt() != 0) stop();
            while (get_interrupt() == 0 && !waiting_.empty() && int(workers_.size()) < workers_wanted_) {
                const uint32_t task = waiting_.front();
                waiting_.pop_front();
                ++attempts_[task];
                workers_.push_back({start_worker(job_, task, threads_), task});
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            std::erase_if(workers_, [this](const Worker& worker) { return has_ended(worker); });
            tell();
        }
        return get_interrupt() != 0 ? kExitSignalBase + get_interrupt() : exit_code_;
    }

    std::string describe() const {
        return fmt::format("{} of {} tasks done, {} failed; {} processes were killed", done_, count_, failed_,
                           killed_);
    }

  private:
    void stop() {
        if (is_stopped_) return;
        is_stopped_ = true;
        for (const Worker& worker : workers_) ::kill(worker.process, SIGTERM);
    }

    bool has_ended(const Worker& worker) {
        int status = 0;
        const pid_t ended = ::waitpid(worker.process, &status, WNOHANG);
        if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
        if (ended < 0) return note_killed(worker, kExitSignalBase), true; // nobody knows how it ended
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : kExitSignalBase + WTERMSIG(status);
        if (code == kExitDone)
            ++done_;
        else if (code > kExitSignalBase)
            note_killed(worker, code);
        else
            note_failed(worker, code);
        return true;
    }

    /// By a signal, whether it could keep its samples or not: another attempt goes on.
    void note_killed(const Worker& worker, int code) {
        ++killed_;
        std::vector<Attempt> lost;
        for (const Attempt& attempt : list_attempts(job_, worker.task))
            if (attempt.state == AttemptState::running && is_process_gone(attempt)) lost.push_back(attempt);
        declare_lost(job_, lost);
        if (get_interrupt() != 0) return;
        if (attempts_[worker.task] < options_.attempts)
            waiting_.push_back(worker.task);
        else
            note_failed(worker, code);
    }

    void note_failed(const Worker& worker, int code) {
        ++failed_;
        if (exit_code_ == kExitDone) exit_code_ = code;
        if (failed_ > kMostTold) return; // `status` tells of all
        printer_.end_line();
        std::string reason;
        for (const Attempt& attempt : list_attempts(job_, worker.task))
            if (attempt.state == AttemptState::failed) reason = read_reason(job_, attempt);
        print_error("relief: warning: task {} ({}) failed with exit code {}{}{}; its log: {}\n", worker.task,
                    describe_task(job_, find_task(job_, worker.task)), code, reason.empty() ? "" : ": ",
                    reason, get_log_file(job_, worker.task).string());
    }

    void tell() {
        Progress progress;
        progress.fraction = double(done_ + failed_) / double(std::max<size_t>(1, count_));
        progress.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        printer_.print(progress, "tasks of the job");
    }

    const FarmJob& job_;
    const SubmitOptions& options_;
    ProgressPrinter printer_;
    std::deque<uint32_t> waiting_;
    std::vector<int> attempts_; ///< a task
    std::vector<Worker> workers_;
    size_t count_, done_ = 0, failed_ = 0, killed_ = 0;
    int workers_wanted_ = 1, threads_ = 1, exit_code_ = kExitDone;
    bool is_stopped_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace

int run_locally(const FarmJob& job, const std::vector<uint32_t>& tasks, const SubmitOptions& options) {
    int exit_code = kExitDone;
    if (!tasks.empty()) {
        std::string summary;
        {
            LocalFarm farm(job, tasks, options);
            exit_code = farm.run();
            summary = farm.describe();
        } // ends the line of progress
        print_output("{}\n", summary);
    }
    if (get_interrupt() != 0) {
        print_error("relief: interrupted; relief farm submit {} goes on\n", job.folder.string());
        return exit_code;
    }
    if (options.merge == MergeStep::without) return exit_code;
    MergeOptions merge;
    merge.threads = options.threads, merge.progress = options.progress;
    const int merged = merge_and_report(job, merge);
    return exit_code != kExitDone ? exit_code : merged;
}

} // namespace relief::cli
