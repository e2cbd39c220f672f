#include "bench/paper1.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "bench/machine.h"
#include "bench/paper1_figures.h"
#include "bench/paper1_goals.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/samples.h"

namespace relief::bench {

namespace {

/// The paper's subdivision limit, and the level above, which reproduces its bytes per patch.
constexpr int kTableLevels[] = {5, 6};

/// The frame whose time has a goal.
constexpr int kPartyWidth = 1920, kPartyHeight = 1080;

std::string format_level(int level) { return level == kAutoLevel ? "auto" : std::to_string(level); }

RenderSettings make_direct_light(const Paper1Options& options) {
    RenderSettings settings = options.settings;
    settings.image.spp = 1, settings.image.bounces = 0;
    settings.surface.mode = SurfaceMode::direct;
    return settings;
}

/// A cache of patch trees that does not grow, so that what memory a scene takes does not hang on the
/// machine's.
RenderSettings make_capped(RenderSettings settings) {
    settings.surface.cache_bytes = kDefaultCacheBytes;
    return settings;
}

RenderSettings make_uncached(RenderSettings settings) {
    settings.surface.cache_bytes = 0;
    return settings;
}

Value describe_tessellation(const Scene& scene, RenderSettings settings, int level) {
    settings.surface.level = level;
    const TessellationCost cost = estimate_tessellation(scene, settings);
    return {{"level", format_level(level)},
            {"micro_quads", cost.micro_quads},
            {"geometry_bytes", cost.geometry_bytes},
            {"structures_bytes", cost.structures_bytes},
            {"total_bytes", cost.geometry_bytes + cost.structures_bytes},
            {"peak_bytes", cost.peak_bytes}};
}

/// A row of Table 1.1.
Value make_table_row(const std::string& name, const Scene& scene, const RenderSettings& settings,
                     const Statistics& direct) {
    const uint64_t total = direct.geometry_bytes + direct.structures_bytes;
    Value tessellated = Value::list();
    std::vector<int> levels = {settings.surface.level};
    for (const int level : kTableLevels)
        if (level != settings.surface.level) levels.push_back(level);
    for (const int level : levels) tessellated.push_back(describe_tessellation(scene, settings, level));
    const auto paper = std::find_if(kPaperMemory.begin(), kPaperMemory.end(),
                                    [&](const PaperMemory& row) { return row.scene == name; });
    return {
        {"scene", name},
        {"patches", direct.patches},
        {"triangles", direct.triangles},
        {"direct",
         {{"geometry_bytes", direct.geometry_bytes},
          {"structures_bytes", direct.structures_bytes},
          {"total_bytes", total},
          {"bytes_a_patch", double(total) / double(direct.patches)},
          {"displacement_bytes", direct.displacement_bytes},
          {"bottom_cache_bytes", direct.bottom_cache_bytes}}},
        {"tessellated_estimate", std::move(tessellated)},
        {"paper", {{"tessellated_bytes", paper->tessellated_bytes}, {"direct_bytes", paper->direct_bytes}}}};
}

/// Tessellated, unless it exceeds the memory limit of the options.
Variant make_tessellated(const Paper1Options& options, const RenderSettings& direct, uint64_t peak_bytes) {
    Variant variant{"tessellated", direct, {}, {}};
    variant.settings.surface.mode = SurfaceMode::tessellated;
    if (peak_bytes > options.tessellated_limit_bytes)
        variant.refusal = fmt::format("left out: making it takes {} bytes, the limit of this run is {}",
                                      peak_bytes, options.tessellated_limit_bytes);
    return variant;
}

Value make_figure1_7(const std::string& name, const std::vector<Variant>& variants, uint64_t peak_bytes) {
    Value scene = {{"scene", name}, {"tessellated_peak_bytes", peak_bytes}, {"variants", Value::list()}};
    for (const Variant& variant : variants) {
        Value entry = {{"name", variant.name}, {"outcome", variant.refusal.empty() ? "measured" : "refused"}};
        if (variant.refusal.empty())
            entry.update(describe_frames(variant.runs));
        else
            entry["reason"] = variant.refusal;
        scene["variants"].push_back(std::move(entry));
    }
    return scene;
}

constexpr std::pair<BottomForm, const char*> kBottomForms[] = {{BottomForm::split, "split"},
                                                               {BottomForm::fused, "fused"}};

/// The direct variants with both forms of the Vulkan engine's patch tree kernels.
void add_bottom_forms(RenderSettings cached, std::vector<Variant>& variants) {
    for (const auto& [form, name] : kBottomForms) {
        cached.experiment.bottom = form;
        variants.push_back({fmt::format("{}, no cache", name), make_uncached(cached), {}, {}});
        variants.push_back({name, cached, {}, {}});
    }
}

/// Rejected variants are left out.
Value make_bottom_forms(const std::string& name, std::span<const Variant> variants) {
    Value entry = {{"scene", name}, {"variants", Value::list()}};
    for (const Variant& variant : variants) {
        if (variant.runs.empty()) continue;
        Value measured = {{"name", variant.name}};
        measured.update(describe_frames(variant.runs));
        entry["variants"].push_back(std::move(measured));
    }
    return entry;
}

Value make_casts(const std::string& name, const std::vector<Variant>& variants) {
    Value entry = {{"scene", name}, {"variants", Value::list()}};
    for (const Variant& variant : variants)
        if (variant.settings.surface.mode == SurfaceMode::direct && !variant.runs.empty())
            entry["variants"].push_back({{"name", variant.name}, {"casts", describe_casts(variant.runs)}});
    return entry;
}

void check_scenes(const std::vector<std::string>& scenes) {
    const std::string known = fmt::format("{}", fmt::join(kPaper1Scenes, ", "));
    if (scenes.empty()) throw Error(ErrorKind::usage, {"no scene to measure", "", "known: " + known});
    for (const std::string& name : scenes)
        if (std::find(kPaper1Scenes.begin(), kPaper1Scenes.end(), name) == kPaper1Scenes.end())
            throw Error(ErrorKind::usage, {"not a scene of paper 1", name, "known: " + known});
}

/// State of a running suite.
class Paper1 {
  public:
    Paper1(const Paper1Options& options, const Report& report) : options_(options), report_(report) {}

    Value run() {
        check_scenes(options_.scenes);
        // The largest first, before the process has held anything else.
        for (const std::string& name : kPaper1Scenes)
            if (std::find(options_.scenes.begin(), options_.scenes.end(), name) != options_.scenes.end())
                measure_scene(name);
        result_["goals"] = make_paper1_goals(result_);
        return std::move(result_);
    }

  private:
    void measure_scene(const std::string& name) {
        report_("making the scene " + name);
        const Scene scene = make_sample_scene(name, Instancing::none);
        const Report report = [&](const std::string& line) { report_(name + ": " + line); };
        const RenderSettings cached = make_direct_light(options_);
        report("bytes");
        const Statistics first = render(scene, make_capped(cached)).statistics;
        if (!result_.contains("suite")) begin(first);
        result_["table1_1"].push_back(make_table_row(name, scene, options_.settings, first));
        if (name == "party") measure_party_frame(scene, cached, first, report);

        const uint64_t peak_bytes = estimate_tessellation(scene, cached).peak_bytes;
        std::vector<Variant> variants = {{"direct, no cache", make_uncached(cached), {}, {}},
                                         {"direct", cached, {}, {}},
                                         make_tessellated(options_, cached, peak_bytes)};
        const size_t figure_variants = variants.size();
        if (cached.device.engine == EngineKind::vulkan) add_bottom_forms(cached, variants);
        measure_in_turn(scene, options_.runs, variants, report);
        if (variants.size() > figure_variants) {
            const std::span<const Variant> forms = std::span(variants).subspan(figure_variants);
            result_["bottom_forms"].push_back(make_bottom_forms(name, forms));
            variants.resize(figure_variants);
        }
        result_["figure1_7"].push_back(make_figure1_7(name, variants, peak_bytes));
        result_["figure1_9"].push_back(make_casts(name, variants));
        if (name == "bark") measure_depths(scene, cached, report);
    }

    void measure_depths(const Scene& scene, RenderSettings settings, const Report& report) {
        settings.image.bounces = options_.bounces;
        std::vector<Variant> variants = {{"direct, no cache", make_uncached(settings), {}, {}},
                                         {"direct", settings, {}, {}}};
        measure_in_turn(make_white(scene), options_.runs, variants, [&](const std::string& line) {
            report(fmt::format("{} bounces, {}", settings.image.bounces, line));
        });
        result_["figure1_10"].push_back(make_casts("bark", variants));
    }

    /// `first`: the first render of the process.
    void measure_party_frame(const Scene& scene, RenderSettings settings, const Statistics& first,
                             const Report& report) {
        settings.image.width = std::min(kPartyWidth, settings.image.width * kPartyWidth / 1280);
        settings.image.height = std::min(kPartyHeight, settings.image.height * kPartyHeight / 720);
        std::vector<Variant> variants = {{"party frame", settings, {}, {}}};
        measure_in_turn(scene, options_.runs, variants, report);
        result_["party"] = {{"peak_resident_bytes", first.peak_resident_bytes},
                            {"width", settings.image.width},
                            {"height", settings.image.height},
                            {"paper_frame_s", kPaperPartyFrameMilliseconds * 1e-3}};
        if (variants[0].refusal.empty()) result_["party"].update(describe_frames(variants[0].runs));
    }

    void begin(const Statistics& first) {
        const RenderSettings& s = options_.settings;
        result_["suite"] = "paper1";
        result_["build"] = describe_build();
        result_["machine"] = describe_machine();
        result_["device"] = describe_device(first);
        result_["settings"] = {{"width", s.image.width},
                               {"height", s.image.height},
                               {"level", format_level(s.surface.level)},
                               {"spp", 1},
                               {"bottom_cache_bytes", s.surface.cache_bytes.value_or(kDefaultCacheBytes)},
                               {"bounces_of_figure1_10", options_.bounces},
                               {"runs", options_.runs},
                               {"warm_up_runs", 1},
                               {"tessellated_limit_bytes", options_.tessellated_limit_bytes},
                               {"scenes", options_.scenes}};
        result_["comparable"] = kComparable;
        for (const PaperStatement& statement : kPaperStatements)
            result_["paper_says"].push_back({{"about", statement.about}, {"text", statement.text}});
        for (const char* part : {"table1_1", "figure1_7", "figure1_9", "figure1_10"})
            result_[part] = Value::list();
    }

    const Paper1Options& options_;
    const Report& report_;
    Value result_;
};

} // namespace

Paper1Options make_quick_options(Paper1Options options) {
    options.settings.image.width = 64, options.settings.image.height = 36;
    options.runs = 1;
    return options;
}

Value run_paper1(const Paper1Options& options, const Report& report) { return Paper1(options, report).run(); }

} // namespace relief::bench
