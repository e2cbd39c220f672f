#include "farm/job.h"

#include <algorithm>
#include <concepts>
#include <cstdio>
#include <istream>
#include <iterator>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/command_line.h"
#include "common/report.h"
#include "common/values.h"
#include "farm/job_file.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "job.json";
constexpr int kLayout = 1; ///< of job folders

/// Numbers as "1-3,7": most lists of frames are one range.
template <class Number> std::string format_ranges(const std::vector<Number>& numbers) {
    std::string text;
    for (size_t first = 0; first < numbers.size();) {
        size_t last = first;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (!text.empty()) text += ',';
        text += last == first ? fmt::format("{}", numbers[first])
                              : fmt::format("{}-{}", numbers[first], numbers[last]);
        first = last + 1;
    }
    return text;
}

/// Of a file inside of the job, its name in it: the folder may be moved, or be mounted elsewhere.
std::string shorten(const fs::path& file, const fs::path& folder) {
    const fs::path inner = file.lexically_relative(folder);
    return inner.empty() || inner.native().starts_with("..") ? file.string() : inner.string();
}

Value describe_estimate(const JobEstimate& e) {
    return {{"ready_s", e.ready_s},
            {"frame_s", e.frame_s},
            {"threads", e.threads},
            {"memory_bytes", e.memory_bytes}};
}

/// A number of the manifest, whose limits are those of `farm plan`. Throws Error{bad_input}.
template <class Number> Number read_number(const Value& record, const char* name, Number least, Number most) {
    const Value& value = record[name];
    const double number = value.get<double>();
    const bool is_whole = std::floating_point<Number> || value.kind() == Value::Kind::integer;
    if (is_whole && number >= double(least) && number <= double(most)) return value.get<Number>();
    throw Error(ErrorKind::bad_input,
                {fmt::format("'{}' is {}, and not {}from {} to {}", name, write_json(value),
                             std::floating_point<Number> ? "" : "an integer ", least, most),
                 "", ""});
}

JobEstimate read_estimate(const Value& value) {
    constexpr double kMostSeconds = 1e9;
    constexpr uint64_t kMostBytes = uint64_t(1) << 50;
    return {read_number(value, "ready_s", 0.0, kMostSeconds),
            read_number(value, "frame_s", 0.0, kMostSeconds), read_number(value, "threads", 1, kMaxThreads),
            read_number(value, "memory_bytes", uint64_t(0), kMostBytes)};
}

std::string read_manifest_text(const fs::path& folder) {
    const fs::path file = folder / kManifest;
    FarmJob place;
    place.folder = folder;
    const std::unique_ptr<std::istream> stream = open_job_file(place, file);
    if (!stream)
        throw Error(ErrorKind::bad_input, {"there is no manifest of a job that can be read", file.string(),
                                           "relief farm plan SCENE.json --frames 1-24 -o JOB writes one"});
    return {std::istreambuf_iterator<char>(*stream), {}};
}

FarmJob read_manifest(const Value& json, const fs::path& folder) {
    FarmJob job;
    job.folder = folder;
    job.version = json["version"].get<std::string>();
    job.scene = json["scene"].get<std::string>();
    job.pictures = folder / json["pictures"].get<std::string>();
    for (const Value& word : json["options"]) job.options.push_back(word.get<std::string>());
    job.frames = parse_frames(json["frames"].get<std::string>());
    job.width = read_number(json, "width", 1, kMaxPictureSize);
    job.height = read_number(json, "height", 1, kMaxPictureSize);
    job.spp = read_number(json, "spp", 1, kMaxSamples);
    job.tiles = read_number(json, "tiles", 1, std::min(kMostTiles, job.height));
    job.passes = read_number(json, "passes", 1, std::min(kMostPasses, job.spp));
    job.heartbeat_s = read_number(json, "heartbeat_s", kLeastHeartbeat_s, kMostHeartbeat_s);
    check_task_count(job.frames.size(), job.tiles, job.passes);
    job.estimate = read_estimate(json["estimate"]);
    for (const Value& file : json["files"]) job.files.push_back(read_input_file(file));
    return job;
}

} // namespace

void check_task_count(size_t frames, int tiles, int passes) {
    const uint64_t count = uint64_t(frames) * uint64_t(tiles) * uint64_t(passes);
    if (count > kMostTasks)
        throw Error(ErrorKind::usage, {fmt::format("these are {} tasks, more than {}", count, kMostTasks),
                                       "--tiles, --passes", "fewer of them"});
}

FarmTask find_task(const FarmJob& job, uint32_t index) {
    if (index >= job.task_count())
        throw Error(ErrorKind::usage, {fmt::format("the job has no task {}", index), "--task",
                                       fmt::format("from 0 to {}", job.task_count() - 1)});
    FarmTask task;
    task.index = index;
    task.frame_index = index / job.tasks_a_frame();
    task.frame = job.frames[task.frame_index];
    const int part = int(index % job.tasks_a_frame());
    task.tile = {part / job.passes, job.tiles};
    const int64_t pass = part % job.passes, spp = job.spp;
    task.samples = {int(spp * pass / job.passes), int(spp * (pass + 1) / job.passes)};
    return task;
}

std::string describe_task(const FarmJob& job, const FarmTask& task) {
    std::string text = fmt::format("frame {}", task.frame);
    if (job.tiles > 1) text += fmt::format(", tile {}/{}", task.tile.index, task.tile.count);
    if (job.passes > 1) text += fmt::format(", samples {}:{}", task.samples.first, task.samples.second);
    return text;
}

FarmJob read_job(const fs::path& folder) {
    if (folder.empty())
        throw Error(ErrorKind::usage, {"no job folder given", "", "the folder that relief farm plan wrote"});
    const std::string text = read_manifest_text(folder);
    const std::string place = (folder / kManifest).string();
    const std::string hint = "plan the job again, into another folder";
    std::optional<FarmJob> job;
    int layout = kLayout;
    try {
        const Value json = read_json(text);
        layout = read_number(json, "layout", 0, 1 << 20);
        if (layout == kLayout) job = read_manifest(json, fs::absolute(folder).lexically_normal());
    } catch (const Error& error) {
        throw Error(ErrorKind::bad_input, {"the manifest is damaged: " + error.message(), place, hint});
    }
    if (!job)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("it is a job folder of layout {}, not {}", layout, kLayout), place,
                     "use the version of Relief that planned it"});
    if (job->frames.empty())
        throw Error(ErrorKind::bad_input, {"the manifest is damaged: there are no tasks", place, hint});
    return *std::move(job);
}

void write_job(const FarmJob& job) {
    Value files = Value::list();
    for (const InputFile& file : job.files) files.push_back(describe_input_file(file));
    Value json = {{"layout", kLayout},
                  {"version", job.version},
                  {"scene", job.scene.string()},
                  {"pictures", shorten(job.pictures, job.folder)},
                  {"options", job.options},
                  {"frames", format_ranges(job.frames)},
                  {"tiles", job.tiles},
                  {"passes", job.passes},
                  {"width", job.width},
                  {"height", job.height},
                  {"spp", job.spp},
                  {"heartbeat_s", job.heartbeat_s},
                  {"estimate", describe_estimate(job.estimate)},
                  {"files", std::move(files)}};
    write_text_file(job.folder / kManifest, write_json(json, 1));
}

void check_version(const FarmJob& job) {
    if (job.version == RELIEF_VERSION_STRING) return;
    throw Error(
        ErrorKind::bad_input,
        {fmt::format(
             "Relief {} planned this job, and this is Relief {}: parts of two versions make no picture",
             job.version, RELIEF_VERSION_STRING),
         (job.folder / kManifest).string(), "run the same version on all machines, or plan the job again"});
}

RenderOptions make_render_options(const FarmJob& job, int threads) {
    RenderOptions options;
    CLI::App app;
    add_render_options(app, options);
    std::vector<std::string> words = {"relief", job.scene.string(), "-o", job.pictures.string()};
    words.insert(words.end(), job.options.begin(), job.options.end());
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    try {
        app.parse(int(arguments.size()), arguments.data());
    } catch (const CLI::ParseError& error) {
        throw Error(ErrorKind::bad_input, {std::string("options of the job: ") + error.what(),
                                           (job.folder / kManifest).string(), "plan the job again"});
    }
    complete_render_options(options);
    if (threads > 0) options.settings.device.threads = threads;
    return options;
}

void apply_task(const FarmTask& task, RenderSettings& settings) {
    ImageSettings& image = settings.image;
    const Window whole = image.crop == Window{} ? Window{0, 0, image.width, image.height} : image.crop;
    image.crop = make_tile_window(whole, task.tile);
    image.first_sample = task.samples.first;
    image.spp = task.samples.second - task.samples.first;
}

std::vector<uint32_t> parse_tasks(const FarmJob& job, const std::string& text) {
    std::vector<uint32_t> tasks;
    const int64_t last_task = int64_t(job.task_count()) - 1;
    for (const std::string& range : split(text, ',')) {
        const size_t dash = range.find('-', 1);
        const int64_t first = parse_integer("--task", range.substr(0, dash), 0, last_task);
        const int64_t last =
            dash == std::string::npos ? first : parse_integer("--task", range.substr(dash + 1), 0, last_task);
        if (last < first) refuse_value("--task", text, "a list of tasks such as 0-7,12");
        for (int64_t task = first; task <= last; ++task) tasks.push_back(uint32_t(task));
    }
    if (tasks.empty()) refuse_value("--task", text, "a list of tasks such as 0-7,12");
    std::ranges::sort(tasks);
    tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
    return tasks;
}

std::string format_tasks(const std::vector<uint32_t>& tasks) { return format_ranges(tasks); }

} // namespace relief::cli
