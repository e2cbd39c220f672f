#include "farm/merge_frames.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/finish_picture.h"
#include "cli/interrupt.h"
#include "cli/picture_settings.h"
#include "cli/render_motion.h"
#include "cli/render_warnings.h"
#include "common/command_line.h"
#include "common/console.h"
#include "common/denoiser_search.h"
#include "common/exit_codes.h"
#include "common/mesh_reader.h"
#include "farm/damaged_part.h"
#include "farm/folder_names.h"
#include "farm/job_file.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"
#include "relief/shot.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

fs::path get_written_folder(const FarmJob& job) { return job.folder / "written"; }

fs::path get_written_mark(const FarmJob& job, size_t frame_index) {
    return get_written_folder(job) / std::to_string(job.frames[frame_index]);
}

void mark_written(const FarmJob& job, size_t frame_index) {
    make_job_folder(job, get_written_folder(job));
    const fs::path mark = get_written_mark(job, frame_index);
    check_job_file(job, mark);
    if (!std::ofstream(mark))
        throw Error(ErrorKind::failed, {"the frame is written, but this cannot be noted", mark.string(),
                                        "check free space and rights of the job folder"});
}

/// The films of all tasks of a frame.
std::vector<FilmPart> list_parts(const FarmJob& job, size_t frame_index, const RenderSettings& whole) {
    std::vector<FilmPart> parts;
    for (uint32_t k = 0; k < job.tasks_a_frame(); ++k) {
        const uint32_t index = uint32_t(frame_index) * job.tasks_a_frame() + k;
        RenderSettings settings = whole;
        apply_task(find_task(job, index), settings);
        const fs::path file = get_film_file(job, index);
        parts.push_back({file.string(), [&job, file] { return open_job_file(job, file); },
                         settings.image.crop, settings.image.first_sample});
    }
    return parts;
}

/// In the order of list_parts.
std::vector<std::optional<FileIdentity>> identify_films(const std::vector<FilmPart>& parts) {
    std::vector<std::optional<FileIdentity>> films;
    for (const FilmPart& part : parts) films.push_back(identify_file(part.name));
    return films;
}

/// Writes frames of one job, one after another.
class FrameMerger {
  public:
    FrameMerger(const FarmJob& job, const MergeOptions& merge)
        : job_(job), options_(make_render_options(job, merge.threads)), shot_(job.scene, make_mesh_reader()) {
        options_.progress = merge.progress;
        options_.checkpoint = {};
        if (options_.is_denoised)
            options_.denoiser =
                std::make_shared<const Denoiser>(load_denoiser(options_.settings.device.threads));
    }

    /// The exit code of `relief render` for this frame; nullopt: a part was damaged or missing, which is
    /// noted unless another machine has replaced it or written the frame.
    std::optional<int> merge(size_t frame_index, MergeReport& report) {
        const int frame = job_.frames[frame_index];
        const double start = get_seconds();
        check_picture(frame);
        check_files(job_.files, shot_.list_files(frame));
        Scene scene = shot_.load(frame);
        const RenderSettings settings = prepare_picture(options_, scene);
        Checkpoints checkpoints;
        checkpoints.parts = list_parts(job_, frame_index, settings);
        const std::vector<std::optional<FileIdentity>> films = identify_films(checkpoints.parts);
        const double load_s = get_seconds() - start;
        ToldWarnings told;
        RenderResult result;
        try {
            RenderWatcher watcher(options_, told, fmt::format("frame {}", frame));
            result = render_shot(shot_, frame, std::move(scene), settings, &watcher, checkpoints);
            if (watcher.is_refused()) return kExitWarnings;
        } catch (const Error& error) {
            std::vector<Error::Parts> faults = {{error.message(), error.where(), error.hint()}};
            faults.insert(faults.end(), error.further().begin(), error.further().end());
            for (const Error::Parts& fault : faults) {
                const auto part = std::ranges::find(checkpoints.parts, fault.where, &FilmPart::name);
                if (part == checkpoints.parts.end()) throw;
                const auto index = size_t(part - checkpoints.parts.begin());
                if (!is_frame_written(job_, frame_index))
                    note_damage(fault, frame_index, index, films[index], report);
            }
            return std::nullopt;
        }
        return finish_picture(options_, settings, name_frame(job_.pictures, frame), {start, load_s}, result,
                              told);
    }

  private:
    /// Pictures of a job that are in its folder stay there.
    void check_picture(int frame) const {
        const fs::path picture = name_frame(job_.pictures, frame);
        const fs::path inner = picture.lexically_relative(job_.folder);
        if (inner.empty() || inner.native().starts_with("..")) return; // --pictures named the place
        check_job_file(job_, picture.parent_path());
        check_job_file(job_, picture);
    }

    void note_damage(const Error::Parts& fault, size_t frame_index, size_t part,
                     const std::optional<FileIdentity>& film, MergeReport& report) {
        const uint32_t task = uint32_t(frame_index) * job_.tasks_a_frame() + uint32_t(part);
        check_openable(get_film_file(job_, task));
        if (!declare_corrupt(job_, task, film)) return;
        print_error("relief: warning: a part is damaged: task {}, {}: {}\n", task,
                    describe_task(job_, find_task(job_, task)), Error::describe(fault));
        report.corrupt.push_back(task);
    }

    const FarmJob& job_;
    RenderOptions options_;
    Shot shot_;
};

void remove_parts(const FarmJob& job, size_t frame_index) {
    for (uint32_t k = 0; k < job.tasks_a_frame(); ++k) {
        std::error_code ignored;
        fs::remove(get_film_file(job, uint32_t(frame_index) * job.tasks_a_frame() + k), ignored);
    }
}

/// Frames of the list that the job has; throws Error{usage} for others.
std::vector<size_t> choose_frames(const FarmJob& job, const std::vector<int>& wanted) {
    std::vector<size_t> chosen;
    for (const int frame : wanted)
        if (std::ranges::find(job.frames, frame) == job.frames.end())
            throw Error(ErrorKind::usage, {fmt::format("the job has no frame {}", frame), "--frames",
                                           "relief farm status JOB tells which it has"});
    for (size_t k = 0; k < job.frames.size(); ++k)
        if (wanted.empty() || std::ranges::find(wanted, job.frames[k]) != wanted.end()) chosen.push_back(k);
    return chosen;
}

std::string_view name_state(TaskState state) {
    switch (state) {
    case TaskState::waiting:
        return "not rendered yet";
    case TaskState::partial:
        return "interrupted, some samples are there";
    case TaskState::failed:
        return "failed";
    case TaskState::stale:
        return "without a sign of life";
    case TaskState::running:
        return "running";
    case TaskState::done:
        break;
    }
    return "done";
}

/// Writes a frame and notes it. A frame whose files are not as they were leaves the others alone.
void merge_frame(const FarmJob& job, const MergeOptions& options, FrameMerger& merger, size_t frame_index,
                 MergeReport& report) {
    std::optional<int> exit_code;
    try {
        exit_code = merger.merge(frame_index, report);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        exit_code = run_guarded([]() -> int { throw; });
    }
    if (!exit_code) {
        if (is_frame_written(job, frame_index))
            ++report.kept;
        else
            report.missing.push_back(frame_index);
        return;
    }
    if (report.exit_code == kExitDone) report.exit_code = *exit_code;
    if (*exit_code != kExitDone) return;
    mark_written(job, frame_index);
    ++report.written;
    if (options.removes_parts) remove_parts(job, frame_index);
}

} // namespace

MergeReport merge_frames(const FarmJob& job, const MergeOptions& options) {
    check_version(job);
    MergeReport report;
    const JobStates states = read_states(job);
    std::optional<FrameMerger> merger; // only where there is something to write
    for (const size_t index : choose_frames(job, options.frames)) {
        if (!states.is_frame_done(job, index)) {
            report.missing.push_back(index);
            continue;
        }
        if (is_frame_written(job, index)) {
            ++report.kept;
            continue;
        }
        catch_interrupts();
        if (!merger) merger.emplace(job, options);
        merge_frame(job, options, *merger, index, report);
        if (get_interrupt() != 0) {
            report.exit_code = kExitSignalBase + get_interrupt();
            break;
        }
    }
    return report;
}

std::string describe_missing(const FarmJob& job, const JobStates& states, size_t frame_index) {
    constexpr size_t kMost = 4;
    std::string text;
    size_t count = 0;
    for (uint32_t k = 0; k < job.tasks_a_frame(); ++k) {
        const uint32_t task = uint32_t(frame_index) * job.tasks_a_frame() + k;
        if (states.tasks[task] == TaskState::done || ++count > kMost) continue;
        text += fmt::format("{}{} (task {}): {}", text.empty() ? "" : "; ",
                            describe_task(job, find_task(job, task)), task, name_state(states.tasks[task]));
    }
    return count > kMost ? fmt::format("{}; and {} more of this frame", text, count - kMost) : text;
}

bool is_frame_written(const FarmJob& job, size_t frame_index) {
    std::error_code code;
    return fs::exists(get_written_mark(job, frame_index), code) &&
           fs::exists(name_frame(job.pictures, job.frames[frame_index]), code);
}

void forget_written_frame(const FarmJob& job, size_t frame_index) {
    std::error_code ignored;
    fs::remove(get_written_mark(job, frame_index), ignored);
}

std::vector<bool> list_written_frames(const FarmJob& job) {
    std::vector<bool> written(job.frames.size());
    std::vector<std::pair<std::string, size_t>> names;
    for (size_t k = 0; k < job.frames.size(); ++k) names.emplace_back(std::to_string(job.frames[k]), k);
    std::ranges::sort(names);
    visit_names(get_written_folder(job), [&](std::string_view name) {
        const auto found = std::ranges::lower_bound(names, name, {}, &std::pair<std::string, size_t>::first);
        if (found != names.end() && found->first == name) written[found->second] = true;
    });
    return written;
}

} // namespace relief::cli
