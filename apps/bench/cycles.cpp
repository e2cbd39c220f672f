#include "bench/cycles.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bench/machine.h"
#include "bench/renderers.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

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

struct CaseRuns {
    RenderTask what;
    std::vector<Measures> cycles, relief;
};

std::vector<CaseRuns> list_cases(int samples) {
    return {{{.samples = 1, .bounces = 0}, {}, {}},
            {{.samples = 1, .bounces = kBounces}, {}, {}},
            {{.samples = samples, .bounces = 0}, {}, {}},
            {{.samples = samples, .bounces = kBounces}, {}, {}},
            {{.samples = 1, .bounces = 0, .importance_map = kDefaultImportanceMap}, {}, {}}};
}

double get_median(const Value& side, const char* measure) { return side[measure]["median"].get<double>(); }

Value describe_case(const CaseRuns& runs) {
    Value result = {{"samples", runs.what.samples},
                    {"bounces", runs.what.bounces},
                    {"importance_map", runs.what.importance_map == kDefaultImportanceMap
                                           ? Value("Blender's default")
                                           : Value(runs.what.importance_map)}};
    const Value cycles = summarize_measures(runs.cycles), relief = summarize_measures(runs.relief);
    for (const char* measure : {"first_sample_s", "render_s", "with_reading_s"})
        result["times_sooner"][measure] = get_median(cycles, measure) / get_median(relief, measure);
    result["share_of_resident_peak"] =
        get_median(relief, "resident_peak_bytes") / get_median(cycles, "resident_peak_bytes");
    result["cycles"] = cycles, result["relief"] = relief;
    return result;
}

class CyclesSuite {
  public:
    CyclesSuite(const CyclesOptions& options, const Report& report)
        : options_(options),
          report_(report),
          threads_(count_threads(options.settings)),
          renderers_(options.relief, options.folder, describe_size(options.settings), threads_) {}

    Value run() {
        make_head();
        for (const std::string& name : options_.scenes) measure(name);
        result_["blender"] = renderers_.blender_version(), result_["device"] = renderers_.device();
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

    void measure(const std::string& name) {
        report_("making the scene " + name);
        save_scene(make_cycles_scene(name), scene_file(name).parent_path());
        Value entry = {{"scene", name}, {"agreement", compare(name)}};
        std::vector<CaseRuns> cases = list_cases(options_.samples);
        for (int run = 1; run <= options_.runs; ++run)
            for (CaseRuns& runs : cases) {
                report_(fmt::format("{}: {} samples, {} bounces, run {}", name, runs.what.samples,
                                    runs.what.bounces, run));
                runs.cycles.push_back(renderers_.render_with_cycles(scene_file(name), runs.what));
                runs.relief.push_back(renderers_.render_with_relief(scene_file(name), runs.what));
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
        RenderTask task{.samples = options_.samples, .bounces = kBounces};
        task.picture = cycles;
        renderers_.render_with_cycles(scene_file(name), task);
        task.picture = relief;
        renderers_.render_with_relief(scene_file(name), task);
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
    int threads_;
    Renderers renderers_;
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
