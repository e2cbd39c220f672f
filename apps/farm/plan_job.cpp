#include "farm/plan_job.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/machine.h"
#include "cli/picture_settings.h"
#include "cli/render_frames.h"
#include "cli/render_motion.h"
#include "cli/render_warnings.h"
#include "common/console.h"
#include "common/inputs.h"
#include "common/mesh_reader.h"
#include "common/progress.h"
#include "common/values.h"
#include "farm/attempts.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

constexpr double kFilesRead = 0.7; ///< of the work; the estimate comes last

/// Folders of a new job, removed again unless it is kept.
class NewJobFolder {
  public:
    explicit NewJobFolder(const fs::path& folder) : folder_(folder) {
        std::error_code code;
        const bool is_there = fs::exists(folder, code);
        if (is_there && !(fs::is_directory(folder, code) && fs::is_empty(folder, code)))
            throw Error(ErrorKind::usage,
                        {"is there already, and nothing in it is written over", folder.string(),
                         "another folder; relief farm status JOB tells what a job there has"});
        is_new_ = !is_there;
        make_job_folder(folder / "frames"), make_job_folder(folder / "state");
    }
    ~NewJobFolder() {
        if (is_kept_) return;
        std::error_code ignored;
        if (is_new_) fs::remove_all(folder_, ignored);
        for (const char* inner : {"frames", "state"}) fs::remove(folder_ / inner, ignored);
    }
    NewJobFolder(const NewJobFolder&) = delete;
    NewJobFolder& operator=(const NewJobFolder&) = delete;
    void keep() { is_kept_ = true; }

  private:
    fs::path folder_;
    bool is_new_ = false, is_kept_ = false;
};

std::vector<int> choose_job_frames(const PlanOptions& options, const Shot& shot) {
    std::vector<int> frames = options.render.frames.empty() ? shot.frames() : options.render.frames;
    if (frames.empty())
        throw Error(ErrorKind::usage, {"the scene file names no frames", options.render.input.string(),
                                       "--frames 1-24; --frames 1 for a still picture"});
    check_task_count(frames.size(), options.tiles, options.passes);
    return frames;
}

/// Files of all frames, once each. Throws Error{bad_input} for a frame that lacks one.
std::set<fs::path> list_all_files(const Shot& shot, const std::vector<int>& frames) {
    std::set<fs::path> files;
    for (const int frame : shot.is_animated() ? frames : std::vector<int>{frames.front()})
        for (const fs::path& file : shot.list_files(frame))
            files.insert(fs::absolute(file).lexically_normal());
    return files;
}

std::vector<InputFile> describe_files(const std::set<fs::path>& names, WorkProgress& progress) {
    std::vector<InputFile> files;
    for (const fs::path& name : names) {
        files.push_back(describe_file(name));
        progress.tell(kFilesRead * double(files.size()) / double(names.size()));
    }
    return files;
}

/// Pictures of any frame that would take the place of a file that any frame reads.
void keep_inputs(const std::set<fs::path>& files, const FarmJob& job) {
    check_frame_names(job.pictures, job.frames);
    std::set<fs::path> places;
    for (const fs::path& file : files) places.insert(find_place(file));
    for (const int frame : job.frames)
        if (const fs::path picture = name_frame(job.pictures, frame); places.contains(find_place(picture)))
            refuse_output(picture);
}

/// What a render warns of. Throws Error{bad_input} for what it refuses.
std::vector<std::string> collect_warnings(const Inspection& inspection) {
    std::vector<std::string> warnings;
    for (const Finding& finding : inspection.findings) {
        if (finding.code == "E-SCENE") throw Error(ErrorKind::bad_input, {finding.text, "", ""});
        if (finding.code == "W-READ" || finding.code == "W-SCENE") warnings.push_back(finding.text);
    }
    return warnings;
}

JobEstimate estimate_cost(const Inspection& inspection, const RenderSettings& settings, const FarmJob& job) {
    std::map<std::string, double> numbers;
    for (const Fact& fact : inspection.facts)
        for (const FactNumber& number : fact.numbers)
            numbers[number.part.empty() ? fact.name : fact.name + "." + number.part] = number.value;
    JobEstimate estimate;
    estimate.ready_s = numbers["time.ready"];
    estimate.frame_s = std::max(0.0, numbers["time"] - numbers["time.ready"]);
    const int given = settings.device.threads;
    estimate.threads = given > 0 ? given : std::max(1, int(std::thread::hardware_concurrency()));
    // What it took to inspect the scene: it was loaded, prepared and rendered in parts. Beside that a task
    // holds the sums of its pixels, their picture, and patch trees.
    constexpr double kBytesAPixel = 128;
    const double film = kBytesAPixel * double(job.width) * double(job.height) / double(job.tiles);
    estimate.memory_bytes =
        peak_resident_bytes() + uint64_t(film) + settings.surface.cache_bytes.value_or(kDefaultCacheBytes);
    return estimate;
}

/// The first frame says how large all are. Returns what it is warned of.
std::vector<std::string> measure_frame(const RenderOptions& options, Shot& shot, FarmJob& job,
                                       WorkProgress& progress) {
    Scene scene = with_scene_hint(options, [&] { return shot.load(job.frames.front()); });
    if (is_moving(shot, scene.camera)) check_motion(options);
    const RenderSettings settings = prepare_picture(options, scene);
    const ImageSettings& image = settings.image;
    job.width = image.width, job.height = image.height, job.spp = image.spp;
    const Window whole = image.crop == Window{} ? Window{0, 0, image.width, image.height} : image.crop;
    if (job.tiles > whole.y1 - whole.y0)
        refuse_value("--tiles", std::to_string(job.tiles),
                     fmt::format("possible: there are only {} rows", whole.y1 - whole.y0));
    if (job.passes > image.spp)
        refuse_value("--passes", std::to_string(job.passes),
                     fmt::format("possible: there are only {} samples", image.spp));
    const Inspection inspection = inspect_scene(scene, settings, progress.part(kFilesRead, 1));
    job.estimate = estimate_cost(inspection, settings, job);
    return collect_warnings(inspection);
}

/// True where they stand in the way of the job.
bool tell_warnings(const std::vector<std::string>& warnings, const RenderOptions& options) {
    if (!options.progress.is_quiet || options.is_strict) print_warnings(warnings, false);
    if (!options.is_strict || warnings.empty()) return false;
    print_error("relief: nothing is planned with warnings under --strict\n");
    return true;
}

} // namespace

std::optional<FarmJob> plan_job(PlanOptions options) {
    FarmJob job;
    job.folder = fs::absolute(options.folder).lexically_normal();
    job.version = RELIEF_VERSION_STRING;
    job.scene = fs::absolute(options.render.input).lexically_normal();
    job.options = options.words;
    job.tiles = options.tiles, job.passes = options.passes, job.heartbeat_s = options.heartbeat_s;
    job.pictures = options.pictures.empty()
                       ? job.folder / "frames" / (options.render.input.stem().string() + ".####.exr")
                       : fs::absolute(options.pictures).lexically_normal();
    refuse_foreign_file(options.render.input);
    if (is_mesh_file(options.render.input))
        throw Error(ErrorKind::usage, {"frames are those of a scene file", options.render.input.string(),
                                       "relief render MESH --save-scene scene.json writes one"});
    NewJobFolder folder(job.folder);
    options.render.output = job.pictures;
    complete_render_options(options.render);
    WorkProgress progress(options.render.progress);
    Shot shot =
        with_scene_hint(options.render, [&] { return Shot(options.render.input, make_mesh_reader()); });
    job.frames = choose_job_frames(options, shot);
    const std::set<fs::path> files = list_all_files(shot, job.frames);
    keep_inputs(files, job);
    job.files = describe_files(files, progress);
    std::vector<std::string> warnings;
    with_io_threads(options.render.settings.device.threads,
                    [&] { warnings = measure_frame(options.render, shot, job, progress); });
    progress.end_line();
    if (tell_warnings(warnings, options.render)) return std::nullopt;
    write_job(job);
    folder.keep();
    return job;
}

} // namespace relief::cli
