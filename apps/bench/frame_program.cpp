#include "bench/frame_program.h"

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/child_process.h"
#include "bench/renderers.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

namespace fs = std::filesystem;

void require_file(const fs::path& file, const std::vector<std::string>& command) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored))
        throw Error(ErrorKind::failed, {fmt::format("did not write {}", file.string()),
                                        describe_command(command), "is this the command `relief`?"});
}

} // namespace

FrameProgram::FrameProgram(fs::path program, fs::path folder, const RenderSettings& s)
    : program_(std::move(program)),
      statistics_(folder / "statistics.json"),
      is_cpu_(s.device.engine == EngineKind::cpu) {
    std::error_code ignored;
    if (!fs::is_regular_file(program_, ignored) || access(program_.c_str(), X_OK) != 0)
        throw Error(ErrorKind::usage, {"no such program", program_.string(), ""});
    fs::create_directories(folder);
    engine_words_ = {"--engine", is_cpu_ ? "cpu" : "vulkan"};
    if (s.device.index >= 0)
        engine_words_.insert(engine_words_.end(), {"--device", std::to_string(s.device.index)});
    // Builds of one version would overwrite each other's compiled kernels.
    if (!is_cpu_) variables_ = {"XDG_CACHE_HOME=" + (fs::absolute(folder) / "cache").string()};
    picture_words_ = {"--size", describe_size(s), "--spp", std::to_string(s.image.spp), "--bounces",
                      std::to_string(s.image.bounces), "--threads", std::to_string(count_threads(s)),
                      // No limit: programs have other defaults, and older ones do not take 0.
                      "--clamp-indirect", "1e9"};
}

fs::path FrameProgram::write_scene(const std::string& name, const fs::path& folder) const {
    const fs::path file = folder / "scene.json";
    const std::vector<std::string> command = {program_.string(), "scene", name, "-o", folder.string()};
    run_checked(command, variables_);
    require_file(file, command);
    return file;
}

std::vector<std::string> FrameProgram::make_command(const FrameTask& task) const {
    std::vector<std::string> words = {program_.string(), "render", task.scene.string(), "-q"};
    words.insert(words.end(), engine_words_.begin(), engine_words_.end());
    if (is_cpu_) words.insert(words.end(), {"--isa", task.isa});
    words.insert(words.end(), picture_words_.begin(), picture_words_.end());
    words.insert(words.end(), {"--seed", std::to_string(task.seed), "-o", task.picture.string(), "--stats",
                               statistics_.string()});
    return words;
}

FrameRun FrameProgram::render(const FrameTask& task) const {
    const std::vector<std::string> command = make_command(task);
    // What an earlier run left must not pass for the work of this one.
    for (const fs::path& file : {statistics_, task.picture}) fs::remove(file);
    const ChildResult child = run_checked(command, variables_);
    for (const fs::path& file : {statistics_, task.picture}) require_file(file, command);
    std::ifstream stream(statistics_);
    FrameRun run{read_json({std::istreambuf_iterator<char>(stream), {}}), child.processor_s};
    if (!run.statistics.contains("time_s") || !run.statistics["time_s"].contains("render"))
        throw Error(ErrorKind::failed,
                    {"its statistics do not have time_s.render", describe_command(command), ""});
    return run;
}

} // namespace relief::bench
