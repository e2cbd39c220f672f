#include "bench/character_programs.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/character_session.h"
#include "bench/child_process.h"
#include "bench/cycles.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMeasure = "relief: measure ", kVersion = "relief: blender ",
                           kHasRelief = "relief: with RELIEF", kLacksRelief = "relief: without RELIEF: ";

/// Measures that the script printed; from_start_s is when the line of the first picture came.
Measures read_measures(const ChildResult& child) {
    Measures measures;
    for (const LogLine& line : child.lines) {
        if (!line.text.starts_with(kMeasure)) continue;
        const std::string rest = line.text.substr(kMeasure.size());
        const size_t space = rest.find(' ');
        if (space == std::string::npos) continue;
        measures[rest.substr(0, space)] = std::stod(rest.substr(space + 1));
        if (rest.starts_with("render_s ")) measures["from_start_s"] = line.seconds;
    }
    return measures;
}

void require(const Measures& measures, const std::vector<std::string>& names,
             const std::vector<std::string>& words) {
    for (const std::string& name : names)
        if (!measures.contains(name))
            throw Error(ErrorKind::failed,
                        {fmt::format("its output has no measure {}", name), describe_command(words), ""});
}

/// Blender fills this in when it is asked about itself.
struct BlenderProbe {
    std::string version, missing_relief;
    bool has_relief = false;
};

BlenderProbe ask_blender(std::vector<std::string> words) {
    words.push_back("--probe");
    BlenderProbe probe;
    for (const LogLine& line : run_checked(words).lines) {
        if (line.text.starts_with(kVersion)) probe.version = line.text.substr(kVersion.size());
        if (line.text == kHasRelief) probe.has_relief = true;
        if (line.text.starts_with(kLacksRelief)) probe.missing_relief = line.text.substr(kLacksRelief.size());
    }
    if (probe.version.empty())
        throw Error(ErrorKind::failed, {"does not name its version", describe_command(words), ""});
    return probe;
}

/// Command that runs a Python script, which follows it, by its name: `python3` has the package bpy.
std::vector<std::string> make_blender_words(const fs::path& program) {
    if (program.filename().string().starts_with("python")) return {program.string(), "-u"};
    return {program.string(), "-b", "-noaudio", "--factory-startup", "--python-exit-code", "3", "--python"};
}

std::vector<std::vector<std::string>> list_blenders(const std::vector<fs::path>& given,
                                                    std::vector<SkippedProgram>& skipped) {
    std::vector<std::vector<std::string>> found;
    for (const fs::path& program : given) {
        std::error_code ignored;
        if (!fs::is_regular_file(program, ignored) || access(program.c_str(), X_OK) != 0)
            throw Error(ErrorKind::usage,
                        {fmt::format("'{}' is not a program", program.string()), "--blender",
                         "name the file of a blender, or of a python3 with the package bpy"});
        found.push_back(make_blender_words(fs::absolute(program)));
    }
    if (!given.empty()) return found;
    try {
        return {find_blender()};
    } catch (const Error& error) {
        for (const char* name : {"Cycles", "Relief in Blender"}) skipped.push_back({name, error.message()});
        return {};
    }
}

/// Compares the numbers in versions such as "5.0.1" and "4.5.15 LTS".
bool is_newer(const std::string& a, const std::string& b) {
    const auto list_numbers = [](const std::string& text) {
        std::array<int, 3> numbers{};
        const char *place = text.data(), *end = place + text.size();
        for (int& number : numbers) {
            place = std::from_chars(place, end, number).ptr;
            if (place < end) ++place; // the point
        }
        return numbers;
    };
    return list_numbers(a) > list_numbers(b);
}

} // namespace

Measures CharacterProgram::render(const CharacterInput& input, const CharacterTask& task) const {
    return kind_ == Kind::relief ? run_command(input, task) : run_blender(input, task, false);
}

Measures CharacterProgram::run_session(const CharacterInput& input, const CharacterTask& task) const {
    if (kind_ == Kind::relief) return run_character_session(input, task);
    return run_blender(input, task, true);
}

Measures CharacterProgram::run_blender(const CharacterInput& input, const CharacterTask& task,
                                       bool is_session) const {
    std::vector<std::string> words = words_;
    const auto add = [&](const char* option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    add("--engine", kind_ == Kind::cycles ? "CYCLES" : "RELIEF");
    add("--scene", fs::absolute(input.scene).string());
    add("--size", fmt::format("{}x{}", task.width, task.height));
    add("--samples", std::to_string(task.samples));
    add("--bounces", std::to_string(task.bounces));
    add("--threads", std::to_string(task.threads));
    add("--importance-map", std::to_string(kImportanceMap));
    if (!task.picture.empty()) add("--output", fs::absolute(task.picture).string());
    std::vector<std::string> expected = {"render_s", "from_start_s", "resident_peak_bytes"};
    if (is_session) {
        words.push_back("--session");
        add("--turn", fmt::format("{}", kSessionTurnDegrees));
        add("--move", fmt::format("{},{},{}", input.move.x, input.move.y, input.move.z));
        expected.insert(expected.end(), {"turned_s", "moved_s"});
        if (!input.changed_map.empty()) {
            add("--changed-map", input.changed_map.string());
            expected.emplace_back("changed_s");
        }
    }
    Measures measures = read_measures(run_checked(words));
    require(measures, expected, words);
    if (!is_session) return measures;
    measures["first_s"] = measures["render_s"];
    for (const char* cold : {"render_s", "from_start_s", "resident_peak_bytes"}) measures.erase(cold);
    return measures;
}

Measures CharacterProgram::run_command(const CharacterInput& input, const CharacterTask& task) const {
    using Clock = std::chrono::steady_clock;
    const fs::path statistics = folder_ / "relief.json";
    const fs::path picture = task.picture.empty() ? folder_ / "relief.exr" : task.picture;
    const std::vector<std::string> words = {words_.at(0),
                                            "render",
                                            input.scene.string(),
                                            "-q",
                                            "--background",
                                            "transparent",
                                            "-o",
                                            picture.string(),
                                            "--stats",
                                            statistics.string(),
                                            "--size",
                                            fmt::format("{}x{}", task.width, task.height),
                                            "--spp",
                                            std::to_string(task.samples),
                                            "--bounces",
                                            std::to_string(task.bounces),
                                            "--threads",
                                            std::to_string(task.threads)};
    const Clock::time_point start = Clock::now();
    run_checked(words);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    std::ifstream stream(statistics);
    const Value s = read_json({std::istreambuf_iterator<char>(stream), {}});
    return {{"render_s", seconds},
            {"from_start_s", seconds},
            {"prepare_s", s["time_s"]["prepare"].get<double>()},
            {"resident_peak_bytes", s["memory_bytes"]["peak_resident"].get<double>()}};
}

CharacterPrograms find_character_programs(const fs::path& relief, const std::vector<fs::path>& blenders,
                                          const fs::path& folder) {
    using Kind = CharacterProgram::Kind;
    fs::create_directories(folder);
    const fs::path script = fs::absolute(folder) / "character_render.py";
    write_text_file(script, character_script());
    write_text_file(folder / "cycles_scene.py", cycles_script());
    CharacterPrograms found;
    struct Blender {
        BlenderProbe probe;
        std::vector<std::string> words;
    };
    std::vector<Blender> answered;
    for (std::vector<std::string> words : list_blenders(blenders, found.skipped)) {
        const std::string program = words.front();
        words.insert(words.end(), {script.string(), "--"});
        try {
            answered.push_back({ask_blender(words), words});
        } catch (const Error& error) {
            found.skipped.push_back({"Blender of " + program, error.message()});
        }
    }
    std::ranges::stable_sort(answered, is_newer, [](const Blender& b) { return b.probe.version; });
    found.programs.emplace_back(Kind::relief, "Relief", std::vector{relief.string()}, folder);
    for (const Blender& blender : answered)
        found.programs.emplace_back(Kind::cycles, "Cycles " + blender.probe.version, blender.words, folder);
    for (const Blender& blender : answered) {
        const std::string name = "Relief in Blender " + blender.probe.version;
        if (blender.probe.has_relief)
            found.programs.emplace_back(Kind::relief_in_blender, name, blender.words, folder);
        else
            found.skipped.push_back({name, blender.probe.missing_relief});
    }
    return found;
}

} // namespace relief::bench
