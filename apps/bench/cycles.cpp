#include "bench/cycles.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/child_process.h"
#include "bench/cycles_log.h"
#include "bench/machine.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

/// Width in texels: Blender's default, 4096, is finer than the sky image and takes seconds to build.
constexpr int kImportanceMap = 512;
constexpr int kDefaultImportanceMap = 0; ///< the script's value for Blender's default
constexpr int kBounces = 4;

constexpr double kFirstSampleGoal = 10, kRenderGoal = 3, kMemoryGoal = 1.0 / 5;

/// Tolerances for equivalent pictures: fraction of hit pixels whose masks differ, and difference in
/// brightness.
constexpr double kMaskTolerance = 0.02, kBrightnessTolerance = 0.1;

constexpr const char* kAboutTimes =
    "Times are from the scene in memory to the picture in memory. Cycles: from the call of the render, "
    "without "
    "the time in which the log says that maps are read. Relief: preparation and rendering of `relief "
    "render`. "
    "Neither has the start of the program, the reading of meshes or the writing of pictures in it. "
    "`with_reading_s` has the reading: of maps for Cycles, of the whole scene for Relief.";
constexpr const char* kAboutWork =
    "Cycles dices at 1 pixel, by the size of the undisplaced surface; Relief chooses levels for cells of 1 "
    "pixel. Both sample light and surface, with the same bounces, and end dim paths by chance, each by its "
    "own "
    "rule.";
constexpr const char* kAboutMemory =
    "Memory is the most that a process had resident since its start, the program itself included. "
    "`cycles_own_peak_bytes` is what Cycles counts of its own.";

struct Case {
    int samples = 1, bounces = 0, importance_map = kImportanceMap;
};

/// Measures of one render of one program.
using Measures = std::map<std::string, double>;

struct CaseRuns {
    Case what;
    std::vector<Measures> cycles, relief;
};

std::vector<CaseRuns> list_cases(int samples) {
    return {{{1, 0, kImportanceMap}, {}, {}},
            {{1, kBounces, kImportanceMap}, {}, {}},
            {{samples, 0, kImportanceMap}, {}, {}},
            {{samples, kBounces, kImportanceMap}, {}, {}},
            {{1, 0, kDefaultImportanceMap}, {}, {}}};
}

Value describe_runs(const std::vector<Measures>& runs) {
    Value result;
    for (const auto& [name, first] : runs.front()) {
        std::vector<double> values;
        for (const Measures& run : runs) values.push_back(run.at(name));
        result[name] = summarize(std::move(values));
    }
    return result;
}

double get_median(const Value& side, const char* measure) { return side[measure]["median"].get<double>(); }

Value describe_case(const CaseRuns& runs) {
    Value result = {{"samples", runs.what.samples},
                    {"bounces", runs.what.bounces},
                    {"importance_map", runs.what.importance_map == kDefaultImportanceMap
                                           ? Value("Blender's default")
                                           : Value(runs.what.importance_map)}};
    const Value cycles = describe_runs(runs.cycles), relief = describe_runs(runs.relief);
    for (const char* measure : {"first_sample_s", "render_s", "with_reading_s"})
        result["times_sooner"][measure] = get_median(cycles, measure) / get_median(relief, measure);
    result["share_of_resident_peak"] =
        get_median(relief, "resident_peak_bytes") / get_median(cycles, "resident_peak_bytes");
    result["cycles"] = cycles, result["relief"] = relief;
    return result;
}

[[noreturn]] void throw_child_error(const std::string& program, const ChildResult& child) {
    std::string end;
    for (size_t k = child.lines.size() - std::min<size_t>(child.lines.size(), 8); k < child.lines.size(); ++k)
        end += "\n" + child.lines[k].text;
    throw Error(ErrorKind::failed,
                {fmt::format("ended with exit code {}:{}", child.exit_code, end), program, ""});
}

class CyclesSuite {
  public:
    CyclesSuite(const CyclesOptions& options, const Report& report) : options_(options), report_(report) {
        const auto blender = find_program("blender");
        if (!blender)
            throw Error(ErrorKind::usage,
                        {"no command `blender` is found in PATH", "bench cycles",
                         "install Blender; on Debian: apt-get install --no-install-recommends blender"});
        blender_ = blender->string();
        threads_ = options.settings.device.threads > 0 ? options.settings.device.threads
                                                       : int(std::thread::hardware_concurrency());
    }

    Value run() {
        std::filesystem::create_directories(options_.folder);
        write_text_file(options_.folder / "cycles_scene.py", cycles_script());
        make_head();
        for (const std::string& name : options_.scenes) measure(name);
        return std::move(result_);
    }

  private:
    void make_head() {
        const RenderSettings& s = options_.settings;
        result_ = {{"suite", "cycles"}, {"build", describe_build()}, {"machine", describe_machine()}};
        result_["settings"] = {{"width", s.image.width},   {"height", s.image.height},
                               {"threads", threads_},      {"runs", options_.runs},
                               {"dicing_rate_pixels", 1},  {"importance_map", kImportanceMap},
                               {"scenes", options_.scenes}};
        result_["comparable"] = Value::list({kAboutTimes, kAboutWork, kAboutMemory});
        result_["scenes"] = Value::list(), result_["goals"] = Value::list();
    }

    std::filesystem::path scene_file(const std::string& name) const {
        return options_.folder / "scenes" / name / "scene.json";
    }
    std::string size() const {
        return fmt::format("{}x{}", options_.settings.image.width, options_.settings.image.height);
    }

    void measure(const std::string& name) {
        report_("making the scene " + name);
        save_scene(make_cycles_scene(name), scene_file(name).parent_path());
        Value entry = {{"scene", name}, {"agreement", compare(name)}};
        std::vector<CaseRuns> cases = list_cases(options_.samples);
        for (int run = 1; run <= options_.runs; ++run)
            for (CaseRuns& runs : cases) {
                report_(fmt::format("{}: {} samples, {} bounces, run {}", name, runs.what.samples,
                                    runs.what.bounces, run));
                runs.cycles.push_back(render_with_cycles(name, runs.what, {}));
                runs.relief.push_back(render_with_relief(name, runs.what, options_.folder / "relief.exr"));
            }
        for (const CaseRuns& runs : cases) entry["cases"].push_back(describe_case(runs));
        add_goals(entry);
        result_["scenes"].push_back(std::move(entry));
    }

    /// Also serves as warm-up.
    Value compare(const std::string& name) {
        report_(name + ": comparing the pictures");
        const std::filesystem::path relief = options_.folder / (name + "_relief.exr");
        const std::filesystem::path cycles = options_.folder / (name + "_cycles.exr");
        const Case picture{options_.samples, kBounces, kImportanceMap};
        render_with_cycles(name, picture, cycles);
        render_with_relief(name, picture, relief);
        const Value agreement = compare_with_cycles(read_image(relief), read_image(cycles));
        const double hits = agreement["hit_pixels"].get<double>();
        const double brightness = agreement["brightness_ratio"].get<double>();
        if (agreement["masks_differ"] > kMaskTolerance * hits || !(hits > 0) ||
            !(std::abs(brightness - 1) <= kBrightnessTolerance))
            throw Error(ErrorKind::failed, {"the pictures of Relief and Cycles are not of the same thing: " +
                                                write_json(agreement),
                                            cycles.string(), ""});
        return agreement;
    }

    /// `picture`: output file; empty: none.
    Measures render_with_cycles(const std::string& name, const Case& what,
                                const std::filesystem::path& picture) {
        std::vector<std::string> words = {blender_,
                                          "-b",
                                          "-noaudio",
                                          "--factory-startup",
                                          "--python-exit-code",
                                          "3",
                                          "--python",
                                          (options_.folder / "cycles_scene.py").string(),
                                          "--"};
        const std::pair<const char*, std::string> arguments[] = {
            {"--scene", scene_file(name).string()},
            {"--size", size()},
            {"--samples", std::to_string(what.samples)},
            {"--bounces", std::to_string(what.bounces)},
            {"--threads", std::to_string(threads_)},
            {"--importance-map", std::to_string(what.importance_map)}};
        for (const auto& [option, value] : arguments) words.insert(words.end(), {option, value});
        if (!picture.empty())
            words.insert(words.end(), {"--output", std::filesystem::absolute(picture).string()});
        const ChildResult child = run_child(words);
        if (child.exit_code != 0) throw_child_error(blender_, child);
        const CyclesTimes times = read_cycles_log(child.lines);
        result_["blender"] = times.version;
        return {{"images_s", times.images_s},
                {"prepare_s", times.synchronisation_s - times.images_s},
                {"first_sample_s", times.first_sample_s - times.images_s},
                {"render_s", times.render_s - times.images_s},
                {"with_reading_s", times.render_s},
                {"cycles_own_peak_bytes", double(times.cycles_peak_bytes)},
                {"resident_peak_bytes", double(times.resident_peak_bytes)}};
    }

    Measures render_with_relief(const std::string& name, const Case& what,
                                const std::filesystem::path& picture) {
        const std::filesystem::path statistics = options_.folder / "relief.json";
        std::vector<std::string> words = {options_.relief.string(), "render", scene_file(name).string(),
                                          "-q"};
        const std::pair<const char*, std::string> arguments[] = {{"-o", picture.string()},
                                                                 {"--stats", statistics.string()},
                                                                 {"--size", size()},
                                                                 {"--spp", std::to_string(what.samples)},
                                                                 {"--bounces", std::to_string(what.bounces)},
                                                                 {"--threads", std::to_string(threads_)}};
        for (const auto& [option, value] : arguments) words.insert(words.end(), {option, value});
        const ChildResult child = run_child(words);
        if (child.exit_code != 0) throw_child_error(options_.relief.string(), child);
        std::ifstream stream(statistics);
        const Value s = read_json({std::istreambuf_iterator<char>(stream), {}});
        const Value& time = s["time_s"];
        const double load = time["load"].get<double>(), prepare = time["prepare"].get<double>();
        const double render = time["render"].get<double>();
        result_["device"] = s["device"];
        return {{"load_s", load},
                {"prepare_s", prepare},
                {"first_sample_s", time["first_image"].get<double>() - load},
                {"render_s", prepare + render},
                {"with_reading_s", load + prepare + render},
                {"with_reading_and_writing_s", time["total"].get<double>()},
                {"resident_peak_bytes", s["memory_bytes"]["peak_resident"].get<double>()}};
    }

    void add_goal(const std::string& name, double goal, double reached, const char* unit, bool is_met) {
        result_["goals"].push_back(
            {{"name", name}, {"goal", goal}, {"reached", reached}, {"unit", unit}, {"met", is_met}});
    }

    void add_goals(const Value& entry) {
        const std::string name = entry["scene"].get<std::string>();
        const Value &first = entry["cases"][0], &longest = entry["cases"][3];
        const double sooner = first["times_sooner"]["first_sample_s"].get<double>();
        add_goal(name + ": first sample, no bounce", kFirstSampleGoal, sooner, "times sooner than Cycles",
                 sooner >= kFirstSampleGoal);
        const double faster = longest["times_sooner"]["render_s"].get<double>();
        add_goal(fmt::format("{}: {} samples, {} bounces", name, options_.samples, kBounces), kRenderGoal,
                 faster, "times sooner than Cycles", faster >= kRenderGoal);
        const double share = longest["share_of_resident_peak"].get<double>();
        add_goal(name + ": peak resident memory", kMemoryGoal, share, "of Cycles'", share <= kMemoryGoal);
    }

    const CyclesOptions& options_;
    const Report& report_;
    std::string blender_;
    int threads_ = 1;
    Value result_;
};

} // namespace

std::vector<std::string> default_cycles_scenes() { return {"rock", "rocks", "pumpkin"}; }

CyclesOptions make_quick_options(CyclesOptions options) {
    options.settings.image.width = 64, options.settings.image.height = 36;
    options.samples = 4;
    options.runs = 1;
    return options;
}

Value run_cycles(const CyclesOptions& options, const Report& report) {
    return CyclesSuite(options, report).run();
}

} // namespace relief::bench
