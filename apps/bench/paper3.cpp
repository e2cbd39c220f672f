#include "bench/paper3.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bench/machine.h"
#include "bench/paper_statement.h"
#include "relief/error.h"
#include "relief/samples.h"

namespace relief::bench {

namespace {

constexpr std::array<PaperStatement, 2> kStatements = {
    {{"methods", "the hybrid method is the best on mobile devices"},
     {"structures",
      "structures that take less memory bandwidth and arithmetic win; wider, shallower trees do"}}};

constexpr std::array<std::string_view, 4> kComparable = {
    "The text that we have prints no figures, and which pair was best on which device is not in it.",
    "The paper's trees are built with the costs 3.0 and 1.5; so are ours here, the bvh by a full sweep with "
    "leaves of up to 8 triangles. Displaced patches have a leaf each.",
    "A frame is one primary ray and one shadow ray a pixel, as in the paper. It includes shading and film.",
    "The paper's fragment and hybrid methods do all their work in one shader; ours trace in fragments and "
    "share the "
    "other kernels with the compute method."};

struct Pair {
    StructureKind structure;
    TraversalKind traversal;
};

/// In the order of the paper.
constexpr std::array<Pair, 4> kPairs = {{{StructureKind::kdtree, TraversalKind::push_down},
                                         {StructureKind::kdtree, TraversalKind::backtrack},
                                         {StructureKind::bvh, TraversalKind::restart_trail},
                                         {StructureKind::bvh, TraversalKind::parent_link}}};

const char* method_name(RenderMethod method) {
    switch (method) {
    case RenderMethod::compute:
        return "compute";
    case RenderMethod::fragment:
        return "fragment";
    case RenderMethod::hybrid:
        return "hybrid";
    }
    return "";
}

/// One variant of rendering a scene, its frames, and the first and last picture.
struct Variant {
    RenderSettings settings;
    std::vector<Statistics> runs;
    std::optional<Image> first, last;
    std::string refusal;

    bool is_measured() const { return refusal.empty() && first; }
};

std::vector<Variant> list_variants(const RenderSettings& base) {
    std::vector<RenderMethod> methods = {RenderMethod::compute};
    if (base.device.engine == EngineKind::vulkan)
        methods = {RenderMethod::compute, RenderMethod::fragment, RenderMethod::hybrid};
    std::vector<Variant> variants;
    for (const Pair& pair : kPairs)
        for (const RenderMethod method : methods) {
            Variant variant{base, {}, {}, {}, {}};
            variant.settings.experiment.structure = pair.structure,
            variant.settings.experiment.traversal = pair.traversal;
            variant.settings.experiment.method = method;
            variants.push_back(std::move(variant));
        }
    return variants;
}

std::string describe(const RenderSettings& s) {
    return fmt::format("{} {}, {}", structure_name(s.experiment.structure),
                       traversal_name(s.experiment.traversal), method_name(s.experiment.method));
}

/// Negative runs are warm-up.
void render_variant(const Scene& scene, Variant& variant, int run) {
    if (!variant.refusal.empty()) return;
    try {
        RenderResult result = render(scene, variant.settings);
        if (run >= 0) variant.runs.push_back(std::move(result.statistics));
        if (!variant.first) variant.first = result.image;
        variant.last = std::move(result.image);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::out_of_memory) throw;
        variant.refusal = error.what();
        variant.runs.clear();
    }
}

/// Reference for all others: the first measured one, or null.
const Variant* find_reference(const std::vector<Variant>& variants) {
    const auto found = std::find_if(variants.begin(), variants.end(),
                                    [](const Variant& variant) { return variant.is_measured(); });
    return found == variants.end() ? nullptr : &*found;
}

/// For either picture.
uint64_t count_different_pixels(const Variant& variant, const Variant& reference) {
    const auto count = [&](const Image& picture) {
        return uint64_t(compare_images(picture, *reference.first, "", 0).over_threshold);
    };
    return std::max(count(*variant.first), count(*variant.last));
}

Value describe_variant(const Variant& variant, const Variant* reference) {
    Value entry = {{"structure", structure_name(variant.settings.experiment.structure)},
                   {"traversal", traversal_name(variant.settings.experiment.traversal)},
                   {"method", method_name(variant.settings.experiment.method)},
                   {"outcome", variant.refusal.empty() ? "measured" : "refused"}};
    if (!variant.refusal.empty()) {
        entry["reason"] = variant.refusal;
        return entry;
    }
    entry.update(describe_frames(variant.runs));
    entry["camera_rays"] = variant.runs.back().camera_rays;
    entry["shadow_rays"] = variant.runs.back().shadow_rays;
    entry["pixels_that_differ"] = count_different_pixels(variant, *reference);
    return entry;
}

/// Goal that the pictures of all variants are equal; missed if fewer than two variants could be compared.
Value make_goals(const Value& result) {
    Value goals = Value::list();
    for (const Value& scene : result["scenes"]) {
        double different = 0;
        int compared = 0;
        for (const Value& variant : scene["ways"]) {
            if (!variant.contains("pixels_that_differ")) continue;
            different = std::max(different, variant["pixels_that_differ"].get<double>());
            ++compared;
        }
        goals.push_back({{"name", fmt::format("{}, pixels that differ between any two of {} ways",
                                              scene["scene"].get<std::string>(), compared)},
                         {"goal", 0},
                         {"reached", different},
                         {"unit", "pixels"},
                         {"met", different <= 0 && compared >= 2}});
    }
    return goals;
}

Value make_head(const Paper3Options& options) {
    const RenderSettings& s = options.settings;
    Value head = {{"suite", "paper3"}, {"build", describe_build()}, {"machine", describe_machine()}};
    head["settings"] = {{"engine", s.device.engine == EngineKind::cpu ? "cpu" : "vulkan"},
                        {"width", s.image.width},
                        {"height", s.image.height},
                        {"spp", 1},
                        {"bounces", 0},
                        {"runs", options.runs},
                        {"warm_up_runs", options.warm_up_runs},
                        {"meshes", options.detail == MeshDetail::full ? "full" : "reduced"},
                        {"scenes", options.scenes}};
    head["comparable"] = kComparable;
    for (const PaperStatement& statement : kStatements)
        head["paper_says"].push_back({{"about", statement.about}, {"text", statement.text}});
    return head;
}

/// One primary and one shadow ray per pixel: keeps only the first light.
Scene light_once(Scene scene) {
    if (scene.lights.empty()) return scene;
    scene.lights.resize(1);
    scene.environment.reset();
    return scene;
}

class Paper3 {
  public:
    Paper3(const Paper3Options& options, const Report& report) : options_(options), report_(report) {}

    Value run() {
        result_ = make_head(options_);
        result_["scenes"] = Value::list();
        const std::vector<std::string> structure_scenes = structure_scene_names();
        for (const std::string& name : options_.scenes) {
            report_("making the scene " + name);
            const bool is_mesh =
                std::find(structure_scenes.begin(), structure_scenes.end(), name) != structure_scenes.end();
            measure(name, is_mesh ? make_structure_scene(name, options_.detail)
                                  : make_sample_scene(name, Instancing::none));
        }
        for (const Scene& scene : options_.meshes) measure(scene.meshes.at(0).name, scene);
        result_["goals"] = make_goals(result_);
        return std::move(result_);
    }

  private:
    void measure(const std::string& name, Scene scene) {
        scene = light_once(std::move(scene));
        RenderSettings base = options_.settings;
        base.image.spp = 1, base.image.bounces = 0;
        base.experiment.sah_costs = SahCosts{}; // as in the paper
        std::vector<Variant> variants = list_variants(base);
        for (int run = -options_.warm_up_runs; run < options_.runs; ++run)
            for (Variant& variant : variants) {
                report_(fmt::format("{}: {}, {}", name, describe(variant.settings),
                                    run < 0 ? std::string("warm-up") : fmt::format("run {}", run + 1)));
                render_variant(scene, variant, run);
            }
        Value entry = {{"scene", name}, {"ways", Value::list()}};
        for (const Variant& variant : variants) {
            entry["ways"].push_back(describe_variant(variant, find_reference(variants)));
            if (variant.runs.empty()) continue;
            entry["patches"] = variant.runs.back().patches,
            entry["triangles"] = variant.runs.back().triangles;
            if (!result_.contains("device")) result_["device"] = describe_device(variant.runs.back());
        }
        result_["scenes"].push_back(std::move(entry));
    }

    const Paper3Options& options_;
    const Report& report_;
    Value result_;
};

} // namespace

std::vector<std::string> paper3_scenes() { return {"body", "hall", "knot", "pumpkin", "bark"}; }

Paper3Options make_quick_options(Paper3Options options) {
    options.settings.image.width = 32, options.settings.image.height = 18;
    options.runs = 1, options.warm_up_runs = 0;
    options.detail = MeshDetail::reduced;
    return options;
}

Value run_paper3(const Paper3Options& options, const Report& report) { return Paper3(options, report).run(); }

} // namespace relief::bench
