#include "bench/frame.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/frame_program.h"
#include "bench/frame_runs.h"
#include "bench/machine.h"
#include "bench/renderers.h"
#include "relief/io.h"
#include "relief/samples.h"

namespace relief::bench {

namespace {

constexpr int kFrameBounces = 4;
constexpr double kFrameGoal = 2;    ///< times the samples a second of the baseline
constexpr uint32_t kSeed = 0;       ///< of the measured runs
constexpr uint32_t kWarmUpSeed = 1; ///< another, so that two pictures of one program show what noise is

constexpr const char* kAboutTime =
    "samples_per_s: pixels times samples over time_s.render, without loading, preparation and writing. "
    "ratio: median over pairs of runs, which take turns; ratio_with_preparation: with time_s.prepare; "
    "ratio_by_processor: by processor time of the whole process, which other programs on the machine disturb "
    "less.";
constexpr const char* kAboutStages =
    "Stages of the CPU engine are summed over threads, of the Vulkan engine times of the device; shares are "
    "of "
    "their sum. Preparation is wall clock, before them. A null is a figure that the program does not tell.";
constexpr const char* kAboutPictures =
    "brightness_difference: mean of R, G and B less that of the baseline, over the latter. "
    "relative_squared_error: mean of (picture - baseline)^2 / (baseline^2 + 0.01). noise: the same of two "
    "pictures "
    "of one program with different seeds: programs of one picture that draw other samples differ by as much.";

class FrameSuite {
  public:
    FrameSuite(const FrameOptions& options, const Report& report)
        : options_(options),
          report_(report),
          relief_(options.relief, options.folder / "relief", make_render_settings(options)) {
        if (!options.baseline.empty())
            baseline_.emplace(options.baseline, options.folder / "baseline", make_render_settings(options));
    }

    Value run() {
        make_head();
        for (const std::string& scene : options_.scenes) {
            report_("making the scene " + scene);
            scene_ = reference().write_scene(scene, options_.folder / "scenes" / scene);
            for (const std::string& isa : options_.isas) measure(scene, isa);
            if (options_.isas.empty()) measure(scene, "");
        }
        return std::move(result_);
    }

  private:
    static RenderSettings make_render_settings(const FrameOptions& options) {
        RenderSettings settings = options.settings;
        settings.image.bounces = kFrameBounces;
        return settings;
    }

    /// That which scenes come from and which the noise is measured of: an older program may not read newer
    /// scenes.
    const FrameProgram& reference() const { return baseline_ ? *baseline_ : relief_; }

    void make_head() {
        const RenderSettings& s = options_.settings;
        const bool is_cpu = s.device.engine == EngineKind::cpu;
        result_ = {{"suite", "frame"},
                   {"build", describe_build()},
                   {"machine", describe_machine()},
                   {"load_average", describe_load()}};
        result_["settings"] = {{"engine", is_cpu ? "cpu" : "vulkan"},
                               {"width", s.image.width},
                               {"height", s.image.height},
                               {"samples", s.image.spp},
                               {"bounces", kFrameBounces},
                               {"threads", count_threads(s)},
                               {"runs", options_.runs},
                               {"isas", options_.isas},
                               {"scenes", options_.scenes}};
        if (baseline_) result_["baseline"] = baseline_->program().string();
        result_["comparable"] = Value::list({kAboutTime, kAboutStages, kAboutPictures});
        result_["cases"] = Value::list(), result_["goals"] = Value::list();
    }

    FrameTask make_task(const char* program, const std::string& scene, const std::string& isa,
                        uint32_t seed) const {
        const std::string name = fmt::format("{}{}{}_{}{}", scene, isa.empty() ? "" : "_", isa, program,
                                             seed == kWarmUpSeed ? "_warm_up" : "");
        return {.scene = scene_, .picture = options_.folder / (name + ".exr"), .isa = isa, .seed = seed};
    }

    void measure(const std::string& scene, const std::string& isa) {
        const std::string what = isa.empty() ? scene : scene + ", " + isa;
        std::vector<FrameRun> own, others;
        for (int run = 0; run <= options_.runs; ++run) {
            const uint32_t seed = run == 0 ? kWarmUpSeed : kSeed;
            const std::string step = run == 0 ? "warm-up" : fmt::format("run {}", run);
            const auto render = [&](const FrameProgram& program, const char* name,
                                    std::vector<FrameRun>& runs) {
                report_(fmt::format("{}: {} of {}", what, step, name));
                FrameRun done = program.render(make_task(name, scene, isa, seed));
                if (run > 0) runs.push_back(std::move(done));
            };
            if (baseline_) render(*baseline_, "baseline", others);
            render(relief_, "relief", own);
        }
        Value entry = {{"scene", scene}, {"isa", isa.empty() ? Value() : Value(isa)}};
        describe(scene, isa, own, others, entry);
        if (baseline_) add_goal(what, entry["ratio"]);
        result_["cases"].push_back(std::move(entry));
    }

    void describe(const std::string& scene, const std::string& isa, const std::vector<FrameRun>& own,
                  const std::vector<FrameRun>& others, Value& entry) const {
        const ImageSettings& image = options_.settings.image;
        const double samples = double(image.width) * double(image.height) * double(image.spp);
        const auto read = [&](const char* program, uint32_t seed) {
            return read_image(make_task(program, scene, isa, seed).picture);
        };
        const char* of_noise = baseline_ ? "baseline" : "relief";
        entry["relief"] = describe_frame_runs(own, samples);
        if (baseline_) {
            entry["baseline"] = describe_frame_runs(others, samples);
            entry.update(compare_frame_runs(own, others));
            entry["picture"] = compare_frame_pictures(read("relief", kSeed), read("baseline", kSeed));
        }
        entry["noise"] = compare_frame_pictures(read(of_noise, kWarmUpSeed), read(of_noise, kSeed));
    }

    void add_goal(const std::string& what, const Value& ratio) {
        if (ratio.kind() == Value::Kind::nothing) return; // no time was measured
        const double reached = ratio["median"].get<double>();
        result_["goals"].push_back({{"name", what + ": samples a second"},
                                    {"goal", kFrameGoal},
                                    {"reached", reached},
                                    {"unit", "times those of the baseline"},
                                    {"met", reached >= kFrameGoal}});
    }

    const FrameOptions& options_;
    const Report& report_;
    FrameProgram relief_;
    std::optional<FrameProgram> baseline_;
    std::filesystem::path scene_;
    Value result_;
};

} // namespace

std::vector<std::string> frame_scene_names() { return sample_scene_names(); }

std::vector<std::string> default_frame_scenes() { return {"pumpkin", "bark", "party"}; }

std::vector<std::string> default_frame_isas() {
    const std::vector<std::string> available = available_isas();
    std::vector<std::string> isas;
    for (const char* isa : {"avx2", "avx512"})
        if (std::ranges::find(available, isa) != available.end()) isas.emplace_back(isa);
    return isas.empty() ? std::vector<std::string>{"best"} : isas;
}

FrameOptions make_quick_options(FrameOptions options) {
    options.settings.image.width = 64, options.settings.image.height = 36;
    options.settings.image.spp = 2;
    options.runs = 1;
    return options;
}

Value run_frame(const FrameOptions& options, const Report& report) {
    return FrameSuite(options, report).run();
}

} // namespace relief::bench
