#include "farm/status_report.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <istream>
#include <memory>

#include <fmt/format.h>

#include "farm/job_file.h"
#include "farm/merge_frames.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

constexpr size_t kMostFailures = 10, kMostLogLines = 3;
constexpr size_t kMostListed = 20; ///< tasks of a kind that are named

std::vector<std::string> read_last_lines(const FarmJob& job, const std::filesystem::path& file,
                                         size_t count) {
    std::unique_ptr<std::istream> opened;
    try {
        opened = open_job_file(job, file);
    } catch (const Error& error) {
        return {error.what()};
    }
    if (!opened) return {};
    std::istream& stream = *opened;
    constexpr std::streamoff kTail = 4096; // logs may be long
    stream.seekg(0, std::ios::end);
    const std::streamoff size = stream.tellg();
    stream.seekg(std::max<std::streamoff>(0, size - kTail));
    std::deque<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
        if (lines.size() > count) lines.pop_front();
    }
    return {lines.begin(), lines.end()};
}

FailedTask describe_failure(const FarmJob& job, const Attempt& attempt) {
    FailedTask failed{attempt, {}, read_last_lines(job, get_log_file(job, attempt.task), kMostLogLines)};
    failed.reason = read_reason(job, attempt);
    return failed;
}

void count_frames(const FarmJob& job, StatusReport& report) {
    const std::vector<bool> written = list_written_frames(job);
    report.frame_count = job.frames.size();
    for (size_t k = 0; k < job.frames.size(); ++k) {
        const auto first = report.states.tasks.begin() + ptrdiff_t(k * job.tasks_a_frame());
        const auto last = first + ptrdiff_t(job.tasks_a_frame());
        const auto done = std::count(first, last, TaskState::done);
        const auto waiting = std::count(first, last, TaskState::waiting);
        report.frames_done += done == last - first, report.frames_begun += waiting != last - first;
        report.frames_written += written[k];
    }
}

void estimate_rates(StatusReport& report) {
    const JobStates& s = report.states;
    if (s.done_attempts == 0 || s.seconds <= 0) return;
    const size_t workers = s.running.size();
    report.rays_per_second = double(s.rays) / s.seconds * double(std::max<size_t>(1, workers));
    const size_t left = s.tasks.size() - s.count(TaskState::done);
    if (left == 0)
        report.left_s = 0;
    else if (workers > 0)
        report.left_s = double(left) * s.seconds / double(s.done_attempts) / double(workers);
}

std::string format_duration(double seconds) {
    const auto whole = int64_t(std::lround(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

/// "task 3 (frame 1, tile 3/4) on HOST": a few of many.
std::string format_attempts(const FarmJob& job, const char* kind, const std::vector<Attempt>& attempts) {
    std::string text;
    for (size_t k = 0; k < std::min(attempts.size(), kMostListed); ++k)
        text += fmt::format("{}: task {} ({}), {}\n", kind, attempts[k].task,
                            describe_task(job, find_task(job, attempts[k].task)), attempts[k].who);
    if (attempts.size() > kMostListed)
        text += fmt::format("{}: {} more\n", kind, attempts.size() - kMostListed);
    return text;
}

std::string format_events(const JobStates& s) {
    std::string text;
    const auto add = [&](size_t count, const char* what) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "events  " : ", ", count, what);
    };
    add(s.lost, "attempts lost without a word"), add(s.partial, "interrupted"),
        add(s.corrupt, "damaged parts");
    add(s.retried, "failures put up again"), add(s.twice, "tasks done more than once");
    return text.empty() ? text : text + "\n";
}

Value list_attempts_as_values(const FarmJob& job, const std::vector<Attempt>& attempts) {
    Value list = Value::list();
    for (const Attempt& attempt : attempts)
        list.push_back({{"task", attempt.task},
                        {"part", describe_task(job, find_task(job, attempt.task))},
                        {"who", attempt.who}});
    return list;
}

} // namespace

StatusReport make_status(const FarmJob& job) {
    StatusReport report;
    report.states = read_states(job);
    count_frames(job, report);
    estimate_rates(report);
    for (const Attempt& attempt : report.states.failed) {
        if (report.failed.size() == kMostFailures) break;
        const bool is_told = !report.failed.empty() && report.failed.back().attempt.task == attempt.task;
        if (is_told) continue;
        report.failed.push_back(describe_failure(job, attempt));
    }
    return report;
}

std::string format_status(const FarmJob& job, const StatusReport& r, StatusDetail detail) {
    const JobStates& s = r.states;
    std::string text = fmt::format(
        "tasks   {} of {} done, {} running, {} stale, {} failed, {} partial, {} waiting\n",
        s.count(TaskState::done), s.tasks.size(), s.count(TaskState::running), s.count(TaskState::stale),
        s.count(TaskState::failed), s.count(TaskState::partial), s.count(TaskState::waiting));
    text += fmt::format("frames  {} of {} done, {} begun, {} written to {}\n", r.frames_done, r.frame_count,
                        r.frames_begun, r.frames_written, job.pictures.string());
    if (detail == StatusDetail::counts) return text;
    if (r.rays_per_second > 0)
        text += fmt::format("speed   {:.3g} Mray/s{}\n", 1e-6 * r.rays_per_second,
                            r.left_s && *r.left_s > 0 ? ", " + format_duration(*r.left_s) + " left" : "");
    text += format_events(s);
    text += format_attempts(job, "running", s.running);
    text += format_attempts(job, "stale", s.stale);
    for (const FailedTask& failed : r.failed) {
        text += fmt::format("failed: task {} ({}), exit {}: {}\n", failed.attempt.task,
                            describe_task(job, find_task(job, failed.attempt.task)), failed.attempt.exit_code,
                            failed.reason);
        for (const std::string& line : failed.log_lines) text += "    " + line + "\n";
    }
    if (s.count(TaskState::failed) > r.failed.size())
        text += fmt::format("failed: {} more\n", s.count(TaskState::failed) - r.failed.size());
    return text;
}

Value describe_status(const FarmJob& job, const StatusReport& r) {
    const JobStates& s = r.states;
    Value failed = Value::list();
    for (const FailedTask& task : r.failed)
        failed.push_back({{"task", task.attempt.task},
                          {"part", describe_task(job, find_task(job, task.attempt.task))},
                          {"who", task.attempt.who},
                          {"exit_code", task.attempt.exit_code},
                          {"reason", task.reason},
                          {"log", task.log_lines}});
    return {{"tasks",
             {{"all", s.tasks.size()},
              {"done", s.count(TaskState::done)},
              {"running", s.count(TaskState::running)},
              {"stale", s.count(TaskState::stale)},
              {"failed", s.count(TaskState::failed)},
              {"partial", s.count(TaskState::partial)},
              {"waiting", s.count(TaskState::waiting)}}},
            {"frames",
             {{"all", r.frame_count},
              {"done", r.frames_done},
              {"begun", r.frames_begun},
              {"written", r.frames_written}}},
            {"events",
             {{"lost", s.lost},
              {"interrupted", s.partial},
              {"damaged", s.corrupt},
              {"retried", s.retried},
              {"done_twice", s.twice}}},
            {"rays_per_second", r.rays_per_second},
            {"left_s", r.left_s ? Value(*r.left_s) : Value()},
            {"running", list_attempts_as_values(job, s.running)},
            {"stale", list_attempts_as_values(job, s.stale)},
            {"failed", std::move(failed)},
            {"read", {{"folders", s.folders_read}, {"names", s.names_read}, {"files", s.files_looked_at}}}};
}

} // namespace relief::cli
