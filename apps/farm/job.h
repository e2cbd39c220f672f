// A job of a farm: frames of a shot, each cut into tasks that are rendered independently of one another, and
// the folder that holds all of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/render_options.h"
#include "farm/input_files.h"
#include "relief/render.h"

namespace relief::cli {

inline constexpr int kMostTiles = 65536, kMostPasses = 4096; ///< per frame
inline constexpr uint64_t kMostTasks = 100'000'000;          ///< per job
inline constexpr double kLeastHeartbeat_s = 0.05, kMostHeartbeat_s = 3600;

/// Throws Error{usage} for more than kMostTasks tasks.
void check_task_count(size_t frames, int tiles, int passes);

/// What one task costs, by what `inspect` measured when the job was planned.
struct JobEstimate {
    double ready_s = 0;        ///< to load and prepare a frame
    double frame_s = 0;        ///< to trace a whole frame, on all threads of that machine
    int threads = 1;           ///< of that machine
    uint64_t memory_bytes = 0; ///< of one task
};

/// What the manifest says.
struct FarmJob {
    std::filesystem::path folder;     ///< of the job, absolute
    std::string version;              ///< of the program that planned it
    std::filesystem::path scene;      ///< absolute
    std::filesystem::path pictures;   ///< of the frames, as name_frame takes it; absolute
    std::vector<std::string> options; ///< words of `relief render` that all tasks share
    std::vector<int> frames;
    int tiles = 1, passes = 1;
    int width = 0, height = 0, spp = 0; ///< of a whole frame
    double heartbeat_s = 10;            ///< a running task shows that it lives so often
    JobEstimate estimate;
    std::vector<InputFile> files; ///< that any frame reads

    uint32_t task_count() const { return uint32_t(frames.size()) * tasks_a_frame(); }
    uint32_t tasks_a_frame() const { return uint32_t(tiles) * uint32_t(passes); }
};

/// Task I of a job: frame by frame, tile by tile, range by range.
struct FarmTask {
    uint32_t index = 0;
    size_t frame_index = 0;
    int frame = 0;
    Tile tile;
    std::pair<int, int> samples; ///< [first, second) of each pixel
};

/// Throws Error{usage} for a number that is beyond the last task.
FarmTask find_task(const FarmJob& job, uint32_t index);

/// "frame 7, tile 2/4, samples 0:16": what is not the whole is named.
std::string describe_task(const FarmJob& job, const FarmTask& task);

/// Reads JOB/job.json. Throws Error{bad_input} where it is missing, damaged or of another layout.
FarmJob read_job(const std::filesystem::path& folder);

/// Writes it; the folder exists.
void write_job(const FarmJob& job);

/// Throws Error{bad_input} where another version planned the job: pictures of two versions may differ.
void check_version(const FarmJob& job);

/// Options of `relief render` that all frames share, with `pictures` as the output; completed. `threads`: in
/// place of what the job says; 0: that.
RenderOptions make_render_options(const FarmJob& job, int threads);

/// From the settings of a whole frame to those of a task: its band of rows and its samples.
void apply_task(const FarmTask& task, RenderSettings& settings);

/// Numbers and ranges of tasks, "0-7,12", in rising order. Throws Error{usage} for one that is not there.
std::vector<uint32_t> parse_tasks(const FarmJob& job, const std::string& text);

/// Its inverse.
std::string format_tasks(const std::vector<uint32_t>& tasks);

} // namespace relief::cli
