#include "farm/work_task.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/finish_picture.h"
#include "cli/interrupt.h"
#include "cli/picture_settings.h"
#include "cli/render_motion.h"
#include "cli/render_warnings.h"
#include "common/command_line.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/mesh_reader.h"
#include "farm/damaged_part.h"
#include "farm/job_file.h"
#include "farm/preview.h"
#include "farm/running_attempt.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"
#include "relief/shot.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

constexpr double kDefaultCheckpointMinutes = 5;

/// From now on all that this process prints goes to the end of the log. Returns where its errors went before.
int open_log(const FarmJob& job, const fs::path& file) {
    make_job_folder(job, file.parent_path());
    check_job_file(job, file);
    const int log = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (log < 0)
        throw Error(ErrorKind::failed, {fmt::format("the log cannot be written: {}", std::strerror(errno)),
                                        file.string(), "check free space and rights of the job folder"});
    flush_output();
    const int errors = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    ::dup2(log, STDOUT_FILENO), ::dup2(log, STDERR_FILENO);
    ::close(log);
    return errors;
}

/// The samples of an earlier attempt, where it left any that can be read.
std::vector<FilmPart> find_earlier_samples(const FarmJob& job, const FarmTask& task,
                                           const RenderSettings& settings) {
    const fs::path file = get_partial_film_file(job, task.index);
    std::error_code code;
    if (!fs::exists(file, code)) return {};
    return {{file.string(), [&job, file] { return open_job_file(job, file); }, settings.image.crop,
             settings.image.first_sample}};
}

/// A frame, ready to be rendered as a task.
struct LoadedTask {
    Scene scene;
    RenderSettings settings;
};

LoadedTask load_task(const FarmTask& task, const RenderOptions& options, Shot& shot) {
    LoadedTask loaded{shot.load(task.frame), {}};
    loaded.settings = prepare_picture(options, loaded.scene);
    apply_task(task, loaded.settings);
    return loaded;
}

/// Renders; of samples that turn out to be damaged nothing is kept.
RenderResult render_task(const FarmJob& job, const FarmTask& task, const RenderOptions& options, Shot& shot,
                         Checkpoints& checkpoints) {
    ToldWarnings told;
    RenderWatcher watcher(options, told, describe_task(job, task));
    LoadedTask loaded = load_task(task, options, shot);
    const std::optional<FileIdentity> earlier = identify_file(get_partial_film_file(job, task.index));
    checkpoints.parts = find_earlier_samples(job, task, loaded.settings);
    try {
        return render_shot(shot, task.frame, std::move(loaded.scene), loaded.settings, &watcher, checkpoints);
    } catch (const Error& error) {
        if (checkpoints.parts.empty() || error.where() != checkpoints.parts.front().name) throw;
        print_error("relief: warning: the samples of an earlier attempt are left out: {}\n", error.what());
        if (earlier) set_aside(checkpoints.parts.front().name, *earlier);
        checkpoints.parts.clear();
        loaded = load_task(task, options, shot);
        return render_shot(shot, task.frame, std::move(loaded.scene), loaded.settings, &watcher, checkpoints);
    }
}

/// Keeps the film in the attempt's file; a failure of the last time is the task's.
class FilmWriter {
  public:
    FilmWriter(const RunningAttempt& attempt, double minutes) : file_(attempt.film_file()) {
        checkpoints.interval_s = 60 * (minutes > 0 ? minutes : kDefaultCheckpointMinutes);
        checkpoints.save = [this](const std::function<void(std::ostream&)>& write) {
            failure_ = nullptr;
            try {
                write_file(file_, write);
            } catch (const std::exception&) {
                failure_ = std::current_exception();
            }
        };
    }
    void rethrow_failure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

    Checkpoints checkpoints;

  private:
    fs::path file_;
    std::exception_ptr failure_;
};

int render_attempt(const FarmJob& job, const FarmTask& task, const RenderOptions& options,
                   RunningAttempt& attempt) {
    Shot shot(job.scene, make_mesh_reader());
    check_files(job.files, shot.list_files(task.frame));
    FilmWriter film(attempt, options.checkpoint.minutes);
    const RenderResult result = render_task(job, task, options, shot, film.checkpoints);
    film.rethrow_failure();
    const Statistics& s = result.statistics;
    if (!result.is_complete && get_interrupt() == 0) { // --strict
        attempt.end_failed(kExitWarnings, "there are warnings, and --strict was given");
        return kExitWarnings;
    }
    if (!result.is_complete) {
        attempt.end_partial();
        print_error("relief: interrupted; the samples so far are kept for the next attempt\n");
        return kExitSignalBase + get_interrupt();
    }
    write_preview(job, task, result.image);
    attempt.end_done(s.camera_rays + s.shadow_rays + s.bounce_rays);
    return kExitDone;
}

bool is_done(const FarmJob& job, uint32_t task) {
    const std::vector<Attempt> attempts = list_attempts(job, task);
    return std::ranges::any_of(attempts, [](const Attempt& a) { return a.state == AttemptState::done; });
}

int work_on_task(const FarmJob& job, const FarmTask& task, const WorkOptions& work) {
    const auto report = [&](std::string_view what) {
        const std::string line = fmt::format("{}: {}\n", what, describe_task(job, task));
        work.is_logged ? write_error(line) : write_output(line); // a log that is full is no failure
    };
    if (!work.is_repeated && is_done(job, task.index)) {
        report(fmt::format("task {} is done already", task.index));
        return kExitDone;
    }
    RunningAttempt attempt(job, task);
    try {
        check_version(job);
        RenderOptions options = make_render_options(job, work.threads);
        if (work.is_quiet) options.progress.is_quiet = true;
        options.is_denoised = false; // the whole picture is, when it is merged
        int exit_code = kExitDone;
        with_io_threads(options.settings.device.threads,
                        [&] { exit_code = render_attempt(job, task, options, attempt); });
        if (exit_code == kExitDone) report(fmt::format("rendered task {}", task.index));
        return exit_code;
    } catch (const Error& error) {
        attempt.end_failed(int(error.kind()), error.what());
        throw;
    } catch (const std::bad_alloc&) {
        attempt.end_failed(int(ErrorKind::out_of_memory), "out of memory");
        throw;
    } catch (const std::exception& error) {
        attempt.end_failed(int(ErrorKind::failed), error.what());
        throw;
    }
}

/// Reports a failure in the log; where that is lost, for instance on a full disk, on the errors of this
/// process.
int work_with_log(const FarmJob& job, const FarmTask& task, const WorkOptions& work) {
    const int errors = open_log(job, get_log_file(job, task.index));
    std::clearerr(stderr);
    const int exit_code = run_guarded([&] { return work_on_task(job, task, work); });
    if (std::ferror(stderr) && exit_code != kExitDone && errors >= 0) {
        std::string reason;
        for (const Attempt& attempt : list_attempts(job, task.index))
            if (attempt.state == AttemptState::failed) reason = ": " + read_reason(job, attempt);
        ::dup2(errors, STDERR_FILENO);
        print_error("relief: error: task {} ended with exit code {}{}; its log cannot be written\n",
                    task.index, exit_code, reason);
    }
    ::dup2(errors, STDERR_FILENO);
    ::close(errors);
    return exit_code;
}

} // namespace

int work_on_tasks(const FarmJob& job, const std::vector<uint32_t>& tasks, const WorkOptions& options) {
    int exit_code = kExitDone;
    for (const uint32_t index : tasks) {
        catch_interrupts();
        const FarmTask task = find_task(job, index);
        // One that fails does not keep the others of the list from being rendered.
        const int code = run_guarded([&] {
            return options.is_logged ? work_with_log(job, task, options) : work_on_task(job, task, options);
        });
        if (exit_code == kExitDone) exit_code = code;
        if (get_interrupt() != 0) return kExitSignalBase + get_interrupt();
    }
    return exit_code;
}

} // namespace relief::cli
