#include "bench/renderers.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/child_process.h"
#include "bench/cycles.h"
#include "bench/cycles_log.h"
#include "bench/measure.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

using Arguments = std::vector<std::pair<const char*, std::string>>;

ChildResult run_with(std::vector<std::string> words, const Arguments& arguments) {
    for (const auto& [option, value] : arguments) words.insert(words.end(), {option, value});
    return run_checked(words);
}

} // namespace

Value summarize_measures(const std::vector<Measures>& runs) {
    Value result;
    for (const auto& [name, first] : runs.front()) {
        std::vector<double> values;
        for (const Measures& run : runs) values.push_back(run.at(name));
        result[name] = summarize(std::move(values));
    }
    return result;
}

std::vector<std::string> find_blender() {
    if (const auto blender = find_program("blender"))
        return {blender->string(),    "-b", "-noaudio", "--factory-startup",
                "--python-exit-code", "3",  "--python"};
    const auto python = find_program("python3");
    constexpr const char* kHasBpy =
        "import importlib.util, sys; sys.exit(not importlib.util.find_spec('bpy'))";
    if (python && run_child({python->string(), "-c", kHasBpy}).exit_code == 0)
        return {python->string(), "-u"};
    throw Error(ErrorKind::usage,
                {"neither a command `blender` nor a `python3` with the package bpy is found in PATH", "bench",
                 "install Blender; on Debian: apt-get install --no-install-recommends blender; or "
                 "pip install bpy"});
}

std::string describe_size(const RenderSettings& settings) {
    return fmt::format("{}x{}", settings.image.width, settings.image.height);
}

int count_threads(const RenderSettings& settings) {
    return settings.device.threads > 0 ? settings.device.threads
                                       : std::max(1, int(std::thread::hardware_concurrency()));
}

Renderers::Renderers(std::filesystem::path relief, std::filesystem::path folder, std::string size,
                     int threads)
    : blender_(find_blender()),
      relief_(std::move(relief)),
      folder_(std::move(folder)),
      size_(std::move(size)),
      threads_(std::to_string(threads)) {
    std::filesystem::create_directories(folder_);
    const std::filesystem::path script = folder_ / "cycles_scene.py";
    write_text_file(script, cycles_script());
    blender_.insert(blender_.end(), {script.string(), "--"});
}

Measures Renderers::render_with_cycles(const std::filesystem::path& scene, const RenderTask& task) {
    Arguments arguments = {{"--scene", scene.string()},
                           {"--size", size_},
                           {"--samples", std::to_string(task.samples)},
                           {"--bounces", std::to_string(task.bounces)},
                           {"--threads", threads_},
                           {"--seed", std::to_string(task.seed)},
                           {"--denoise", task.is_denoised ? "1" : "0"},
                           {"--importance-map", std::to_string(task.importance_map)}};
    if (!task.picture.empty())
        arguments.emplace_back("--output", std::filesystem::absolute(task.picture).string());
    const CyclesTimes times = read_cycles_log(run_with(blender_, arguments).lines);
    blender_version_ = times.version;
    return {{"images_s", times.images_s},
            {"prepare_s", times.synchronisation_s - times.images_s},
            {"first_sample_s", times.first_sample_s - times.images_s},
            {"render_s", times.render_s - times.images_s},
            {"with_reading_s", times.render_s},
            {"cycles_own_peak_bytes", double(times.cycles_peak_bytes)},
            {"resident_peak_bytes", double(times.resident_peak_bytes)}};
}

Measures Renderers::render_with_relief(const std::filesystem::path& scene, const RenderTask& task) {
    const std::filesystem::path statistics = folder_ / "relief.json";
    const std::filesystem::path picture = task.picture.empty() ? folder_ / "relief.exr" : task.picture;
    std::vector<std::string> words = {relief_.string(), "render",     scene.string(), "-q",
                                      "--background",   "transparent"};
    if (task.is_denoised) words.push_back("--denoise");
    run_with(std::move(words), {{"-o", picture.string()},
                                {"--stats", statistics.string()},
                                {"--size", size_},
                                {"--spp", std::to_string(task.samples)},
                                {"--bounces", std::to_string(task.bounces)},
                                {"--clamp-indirect", "0"}, // as of Cycles in cycles_scene.py
                                {"--seed", std::to_string(task.seed)},
                                {"--threads", threads_}});
    std::ifstream stream(statistics);
    const Value s = read_json({std::istreambuf_iterator<char>(stream), {}});
    const Value& time = s["time_s"];
    const double load = time["load"].get<double>(), prepare = time["prepare"].get<double>();
    const double render = time["render"].get<double>(), denoise = time["denoise"].get<double>();
    device_ = s["device"];
    return {{"load_s", load},
            {"prepare_s", prepare},
            {"first_sample_s", time["first_image"].get<double>() - load},
            {"render_s", prepare + render + denoise},
            {"denoise_s", denoise},
            {"with_reading_s", load + prepare + render + denoise},
            {"with_reading_and_writing_s", time["total"].get<double>()},
            {"resident_peak_bytes", s["memory_bytes"]["peak_resident"].get<double>()}};
}

} // namespace relief::bench
