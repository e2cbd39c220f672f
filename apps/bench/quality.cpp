#include "bench/quality.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bench/cycles.h"
#include "bench/error_curve.h"
#include "bench/machine.h"
#include "bench/renderers.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

constexpr int kQualityBounces = 4;
constexpr int kSampleStep = 4;    ///< of a series, times the samples before
constexpr int kMoreSamples = 4;   ///< of Relief's longest picture, times those of Cycles
constexpr int kReferenceSeed = 2; ///< not that of the pictures, whose samples it would share
constexpr double kQualityGoal = 5;

constexpr const char* kAboutError = "Error: mean of (picture - reference)^2 / (reference^2 + 0.01) over "
                                    "pixels and R, G, B, background 0. Each "
                                    "program is held against a reference of its own, with another seed and "
                                    "without a denoiser, whose own noise is "
                                    "in the error.";
constexpr const char* kAboutQualityTime =
    "Times are from the scene in memory to the picture in memory, denoising included, as in the suite "
    "cycles. "
    "`times_sooner`: time of Cycles over the time in which Relief has the same error, interpolated in "
    "logarithms "
    "between its pictures; where Relief's picture of one sample is better already, over the time of that.";

enum class Program { cycles, relief };

struct Series {
    Program program = Program::cycles;
    bool is_denoised = false;
    std::vector<ErrorPoint> points;
};

Value describe_series(const Series& series) {
    Value points = Value::list();
    for (const ErrorPoint& p : series.points)
        points.push_back(Value{{"samples", p.samples}, {"seconds", p.seconds}, {"error", p.error}});
    return {{"program", series.program == Program::cycles ? "cycles" : "relief"},
            {"denoised", series.is_denoised},
            {"points", points}};
}

/// A row for each picture of Cycles.
void compare_series(const Series& cycles, const Series& relief, Value& rows) {
    for (const ErrorPoint& point : cycles.points) {
        Value row = {{"denoised", cycles.is_denoised},
                     {"cycles_samples", point.samples},
                     {"error", point.error},
                     {"cycles_s", point.seconds}};
        if (const auto seconds = find_seconds(relief.points, point.error)) {
            row["relief_s"] = *seconds;
            row["times_sooner"] = point.seconds / *seconds;
        }
        rows.push_back(std::move(row));
    }
}

class QualitySuite {
  public:
    QualitySuite(const QualityOptions& options, const Report& report)
        : options_(options),
          report_(report),
          renderers_(options.relief, options.folder, describe_size(options.settings),
                     count_threads(options.settings)) {}

    Value run() {
        make_head();
        for (const std::string& name : options_.scenes) measure(name);
        result_["blender"] = renderers_.blender_version(), result_["device"] = renderers_.device();
        return std::move(result_);
    }

  private:
    void make_head() {
        const RenderSettings& s = options_.settings;
        result_ = {{"suite", "quality"}, {"build", describe_build()}, {"machine", describe_machine()}};
        result_["settings"] = {
            {"width", s.image.width},      {"height", s.image.height},
            {"threads", count_threads(s)}, {"runs", options_.runs},
            {"bounces", kQualityBounces},  {"reference_samples", options_.reference_samples},
            {"scenes", options_.scenes}};
        result_["comparable"] = Value::list({kAboutError, kAboutQualityTime});
        result_["scenes"] = Value::list(), result_["goals"] = Value::list();
    }

    void measure(const std::string& name) {
        scene_ = options_.folder / "scenes" / name / "scene.json";
        save_scene(make_cycles_scene(name), scene_.parent_path());
        Value entry = {{"scene", name}, {"series", Value::list()}, {"same_error", Value::list()}};
        const Image cycles_reference = make_reference(name, Program::cycles);
        const Image relief_reference = make_reference(name, Program::relief);
        for (const bool is_denoised : {false, true}) {
            const Series cycles = measure_series(name, Program::cycles, is_denoised, cycles_reference);
            entry["series"].push_back(describe_series(cycles));
            try {
                const Series relief = measure_series(name, Program::relief, is_denoised, relief_reference);
                entry["series"].push_back(describe_series(relief));
                compare_series(cycles, relief, entry["same_error"]);
                add_goal(name, cycles, relief);
            } catch (const Error& error) {
                if (!is_denoised) throw;
                entry["denoised_relief"] = "left out: " + error.message();
            }
        }
        result_["scenes"].push_back(std::move(entry));
    }

    Measures render(Program program, const RenderTask& task) {
        return program == Program::cycles ? renderers_.render_with_cycles(scene_, task)
                                          : renderers_.render_with_relief(scene_, task);
    }

    std::filesystem::path picture_file(const std::string& name, Program program,
                                       const std::string& what) const {
        return options_.folder /
               fmt::format("{}_{}_{}.exr", name, program == Program::cycles ? "cycles" : "relief", what);
    }

    Image make_reference(const std::string& name, Program program) {
        const RenderTask task{.samples = options_.reference_samples,
                              .bounces = kQualityBounces,
                              .seed = kReferenceSeed,
                              .picture = picture_file(name, program, "reference")};
        report_(fmt::format("{}: reference of {} samples", task.picture.stem().string(), task.samples));
        render(program, task);
        return read_image(task.picture);
    }

    Series measure_series(const std::string& name, Program program, bool is_denoised,
                          const Image& reference) {
        Series series{program, is_denoised, {}};
        const int factor = program == Program::relief ? kMoreSamples : 1;
        for (int samples = 1; samples <= factor * options_.most_samples; samples *= kSampleStep) {
            const RenderTask task{
                .samples = samples,
                .bounces = kQualityBounces,
                .is_denoised = is_denoised,
                .picture = picture_file(name, program,
                                        fmt::format("{}{}", samples, is_denoised ? "_denoised" : ""))};
            report_(task.picture.stem().string());
            std::vector<double> seconds;
            for (int run = 0; run < options_.runs; ++run)
                seconds.push_back(render(program, task).at("render_s"));
            series.points.push_back({samples, summarize(std::move(seconds))["median"].get<double>(),
                                     compute_relative_error(read_image(task.picture), reference)});
        }
        return series;
    }

    /// At the error of the best picture of Cycles.
    void add_goal(const std::string& name, const Series& cycles, const Series& relief) {
        const ErrorPoint& best = cycles.points.back();
        const auto seconds = find_seconds(relief.points, best.error);
        const double sooner = seconds ? best.seconds / *seconds : 0;
        result_["goals"].push_back(
            {{"name", fmt::format("{}: error of {} samples of Cycles{}", name, best.samples,
                                  cycles.is_denoised ? ", both denoised" : "")},
             {"goal", kQualityGoal},
             {"reached", sooner},
             {"unit", "times sooner than Cycles"},
             {"met", sooner >= kQualityGoal}});
    }

    const QualityOptions& options_;
    const Report& report_;
    Renderers renderers_;
    std::filesystem::path scene_;
    Value result_;
};

} // namespace

std::vector<std::string> default_quality_scenes() { return {"rock", "pumpkin"}; }

QualityOptions make_quick_options(QualityOptions options) {
    options.settings.image.width = 64, options.settings.image.height = 36;
    options.most_samples = 4, options.reference_samples = 64;
    options.runs = 1;
    return options;
}

Value run_quality(const QualityOptions& options, const Report& report) {
    return QualitySuite(options, report).run();
}

} // namespace relief::bench
