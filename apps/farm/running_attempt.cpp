#include "farm/running_attempt.h"

#include <cstdio>
#include <exception>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

#include "common/console.h"
#include "farm/job_file.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

/// By the clock of the storage, where it has one of its own.
void renew_time(const fs::path& file) { ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0); }

void forget_dead_attempts(const FarmJob& job, uint32_t task) {
    const double now_s = read_storage_clock(job);
    for (const Attempt& attempt : list_attempts(job, task)) {
        if (attempt.state != AttemptState::running) continue;
        const std::optional<double> silence_s = measure_silence(job, attempt, now_s);
        if (silence_s && is_stale(job, attempt, *silence_s)) declare_dead(job, attempt);
    }
}

} // namespace

RunningAttempt::RunningAttempt(const FarmJob& job, const FarmTask& task) : job_(job) {
    attempt_.task = task.index, attempt_.who = make_attempt_name();
    for (const fs::path& file :
         {get_attempt_file(job, attempt_), get_film_file(job, task.index), get_preview_file(job, task.index)})
        make_job_folder(job, file.parent_path());
    forget_dead_attempts(job, task.index);
    begin_attempt(job, attempt_);
    heart_ = std::thread([this] { beat(); });
}

RunningAttempt::~RunningAttempt() {
    stop_beating();
    if (has_ended_) return;
    try {
        end_failed(int(ErrorKind::failed), "it ended by an exception");
    } catch (const std::exception& error) {
        print_error("relief: warning: {}\n", error.what());
    }
}

fs::path RunningAttempt::film_file() const { return get_attempt_film_file(job_, attempt_); }

void RunningAttempt::beat() {
    const fs::path file = get_attempt_file(job_, attempt_);
    const std::chrono::duration<double> pause(job_.heartbeat_s);
    std::unique_lock lock(mutex_);
    while (!is_over_.wait_for(lock, pause, [this] { return must_stop_; })) renew_time(file);
}

void RunningAttempt::stop_beating() {
    {
        const std::scoped_lock lock(mutex_);
        must_stop_ = true;
    }
    is_over_.notify_all();
    if (heart_.joinable()) heart_.join();
}

void RunningAttempt::end(Attempt after) {
    stop_beating();
    has_ended_ = true;
    change_attempt(job_, attempt_, after);
    std::error_code ignored;
    if (after.state != AttemptState::failed) fs::resize_file(get_attempt_file(job_, after), 0, ignored);
}

void RunningAttempt::end_done(uint64_t rays) {
    rename_job_file(film_file(), get_film_file(job_, attempt_.task));
    std::error_code ignored;
    fs::remove(get_partial_film_file(job_, attempt_.task), ignored);
    Attempt after = attempt_;
    after.state = AttemptState::done, after.rays = rays;
    after.milliseconds = uint64_t(
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start_)
            .count());
    end(after);
}

void RunningAttempt::end_partial() {
    std::error_code code;
    if (fs::exists(get_film_file(job_, attempt_.task), code)) // another attempt has all samples
        fs::remove(film_file(), code);
    else if (fs::exists(film_file(), code))
        rename_job_file(film_file(), get_partial_film_file(job_, attempt_.task));
    Attempt after = attempt_;
    after.state = AttemptState::partial;
    end(after);
}

void RunningAttempt::end_failed(int exit_code, const std::string& reason) {
    std::error_code ignored;
    fs::remove(film_file(), ignored);
    Attempt after = attempt_;
    after.state = AttemptState::failed, after.exit_code = exit_code;
    end(after);
    write_reason(job_, after, reason);
}

} // namespace relief::cli
