// What a scene is, what it costs as it is and what it would cost tessellated.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/mesh_statistics.h"
#include "api/make_engine.h"
#include "api/picture_report.h"
#include "base/progress.h"
#include "base/timer.h"
#include "cpu/path_tracer.h"
#include "film/film.h"
#include "inspect/facts.h"
#include "inspect/map_mistakes.h"
#include "prepare/prepared_scene.h"
#include "prepare/tessellate.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"
#include "relief/inspect.h"

namespace relief {

namespace {

/// A displacement and a mesh that an object puts together.
using Pair = std::pair<uint32_t, uint32_t>;

std::set<Pair> list_displaced(const Scene& scene) {
    std::set<Pair> pairs;
    for (const Object& object : scene.objects)
        if (object.displacement != kNoIndex) pairs.insert({object.displacement, object.mesh});
    return pairs;
}

/// Maps, each with the first mesh that it is used on.
void describe_maps(const Scene& scene, const std::set<Pair>& pairs, ProgressCounter& steps,
                   Inspection& result) {
    for (uint32_t index = 0; index < scene.displacements.size(); ++index) {
        const Displacement& map = scene.displacements[index];
        steps.add(1);
        if (!has_all_textures(map)) continue;
        const auto pair = pairs.lower_bound({index, 0});
        const bool is_used = pair != pairs.end() && pair->first == index;
        const Mesh* mesh = is_used ? &scene.meshes.at(pair->second) : nullptr;
        const Inspection inspection = inspect_map(map, MapMeaning::declared, mesh);
        for (const Fact& fact : inspection.facts)
            result.facts.push_back({fmt::format("map.{}.{}", map.name, fact.name), fact.value, fact.numbers});
        if (std::string frame = describe_frame(map, mesh); !frame.empty())
            result.facts.push_back({fmt::format("map.{}.frame", map.name), std::move(frame), {}});
        for (const Finding& finding : inspection.findings)
            result.findings.push_back({finding.severity, finding.code,
                                       fmt::format("displacement '{}': {}", map.name, finding.text)});
    }
}

void add_mesh_findings(const Mesh& mesh, const Displacement* map, Inspection& result) {
    for (const Finding& finding : inspect_mesh(mesh, map).findings) {
        // Uvs and quads matter where a map is applied only.
        if (finding.severity != Severity::error && !map) continue;
        result.findings.push_back(
            {finding.severity, finding.code, fmt::format("mesh '{}': {}", mesh.name, finding.text)});
    }
}

void describe_meshes(const Scene& scene, const std::set<Pair>& pairs, ProgressCounter& steps,
                     Inspection& result) {
    std::set<uint32_t> displaced;
    for (const auto& [map, mesh] : pairs) {
        if (displaced.insert(mesh).second)
            result.facts.push_back({fmt::format("mesh.{}.base", scene.meshes.at(mesh).name),
                                    describe_base(scene.meshes.at(mesh)),
                                    {}});
        add_mesh_findings(scene.meshes.at(mesh), &scene.displacements.at(map), result);
        steps.add(1);
    }
    for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
        if (displaced.count(mesh) == 0) add_mesh_findings(scene.meshes[mesh], nullptr, result);
}

/// Reads what an engine has built when it has taken the first sample; nothing is traced at that moment.
class FirstPass final : public RenderObserver {
  public:
    explicit FirstPass(const Engine& engine) : engine_(engine) {}
    void on_progress(const Progress& progress) override {
        if (progress.samples_done > 0 && !is_done_) engine_.add_statistics(statistics_), is_done_ = true;
    }
    bool is_cancelled() const override { return false; }
    double bottom_build_s() const { return statistics_.bottom_build_s; }

  private:
    const Engine& engine_;
    Statistics statistics_;
    bool is_done_ = false;
};

/// Times all passes over parts of a picture: the first sample builds most trees, those after it share them.
class TrialRender {
  public:
    TrialRender(const std::shared_ptr<const PreparedScene>& prepared, const RenderSettings& settings)
        : settings_(settings) {
        settings_.image.spp = std::min(settings.image.spp, kMostSamples);
        settings_.device.engine = EngineKind::cpu;
        engine_ = make_engine(prepared, settings_);
        const ImageSettings& image = settings_.image;
        const int tiles = kTilesOfAThread * std::max(1, read_statistics().threads);
        const int columns = (image.width + kTileEdge - 1) / kTileEdge;
        width_ = std::min(tiles, columns) * kTileEdge;
        height_ = std::max(1, tiles / columns) * kTileEdge;
        columns_ = (image.width + width_ - 1) / width_;
        part_count_ = columns_ * ((image.height + height_ - 1) / height_);
        // Near the golden section, which spreads any number of parts evenly.
        stride_ = std::max(1, int(0.618 * part_count_));
        while (std::gcd(stride_, part_count_) != 1) ++stride_;
    }

    /// Of the picture, each of as many tiles as keep all threads at work.
    int part_count() const { return part_count_; }
    int sample_count() const { return settings_.image.spp; }

    struct Seconds {
        double first = 0, next = 0; ///< of the first sample, and of all others
        double build = 0;           ///< of the first, for patch trees
    };
    /// Parts [0, part_count) are the whole picture; one after another is far from the one before.
    Seconds time_part(int part) {
        const ImageSettings& image = settings_.image;
        const int place = int(int64_t(part) * stride_ % part_count_);
        const int x0 = place % columns_ * width_, y0 = place / columns_ * height_;
        Film film(image.width, image.height,
                  {x0, y0, std::min(image.width, x0 + width_), std::min(image.height, y0 + height_)}, {});
        const Statistics before = read_statistics();
        const Timer timer;
        FirstPass first_pass(*engine_);
        engine_->render(film, &first_pass);
        const double all = timer.seconds();
        const Statistics after = read_statistics();
        // Stages are summed over threads.
        const double build =
            (first_pass.bottom_build_s() - before.bottom_build_s) / std::max(1, after.threads);
        return {after.first_image_s, all - after.first_image_s, build};
    }

  private:
    static constexpr int kMostSamples = 16; ///< passes up to 1, 4 and 16: later ones take as long as the last
    static constexpr int kTileEdge = cpu::kTileEdge, kTilesOfAThread = 6;

    Statistics read_statistics() const {
        Statistics statistics;
        engine_->add_statistics(statistics);
        return statistics;
    }

    RenderSettings settings_;
    std::unique_ptr<Engine> engine_;
    int width_ = 0, height_ = 0, columns_ = 1, part_count_ = 1;
    int stride_ = 1; ///< has no factor in common with part_count_
};

/// What `count` parts take whose trees are shared: building grows as the power fitted to the timed parts.
double extrapolate_build(const std::vector<TrialRender::Seconds>& parts, int count) {
    double half = 0, all = 0;
    for (size_t k = 0; k < parts.size(); ++k) {
        all += parts[k].build;
        if (k < parts.size() / 2) half += parts[k].build;
    }
    if (parts.size() < 2 || !(half > 0)) return all * count / double(parts.size());
    const double whole = double(parts.size()), part = double(parts.size() / 2);
    const double power = std::clamp(std::log(all / half) / std::log(whole / part), 0.0, 1.0);
    return all * std::pow(count / whole, power);
}

/// What a render would take: parts of the picture are rendered for about a second and a half with a few
/// samples. Tracing grows with pixels and samples, building of patch trees for the first sample with the part
/// of the surfaces that is seen; what later samples build they build for all pixels, as trees were dropped.
Fact estimate_time(const std::shared_ptr<const PreparedScene>& prepared, double prepare_s,
                   const RenderSettings& settings, const ProgressFunction& on_progress) {
    constexpr double kBudget_s = 1.5;
    const Timer timer;
    TrialRender trial(prepared, settings);
    const double ready_s = prepare_s + timer.seconds();
    const Timer trial_timer;
    std::vector<TrialRender::Seconds> parts;
    double first_s = 0, next_s = 0, built_s = 0;
    while (int(parts.size()) < trial.part_count() &&
           (parts.size() < 2 || trial_timer.seconds() < kBudget_s)) {
        parts.push_back(trial.time_part(int(parts.size())));
        first_s += parts.back().first, next_s += parts.back().next, built_s += parts.back().build;
        if (const double done = trial_timer.seconds() / kBudget_s; on_progress && done < 1) on_progress(done);
    }
    // Also where all parts took less than the time there is.
    if (on_progress) on_progress(1);
    const double share = double(parts.size()) / trial.part_count();
    const double build_s = extrapolate_build(parts, trial.part_count());
    first_s = std::max(0.0, first_s - built_s) / share + build_s;
    const int more = settings.image.spp - 1, timed = trial.sample_count() - 1;
    next_s = timed > 0 ? next_s / share * more / timed : 0;
    const double all_s = ready_s + first_s + next_s;
    return {"time",
            fmt::format("about {:.2g} s to be ready, {:.2g} s for the first sample, {:.3g} s for all {} at "
                        "{}x{} on the CPU; measured on {} of {} parts of the picture",
                        ready_s, first_s, all_s, settings.image.spp, settings.image.width,
                        settings.image.height, parts.size(), trial.part_count()),
            {{"", all_s, "s"},
             {"ready", ready_s, "s"},
             {"first_sample", first_s, "s"},
             {"samples", double(settings.image.spp), "count"}}};
}

void describe_cost(const Scene& scene, const RenderSettings& settings, const ProgressFunction& on_progress,
                   Inspection& result) {
    const Timer timer;
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings, SceneOrigin::camera);
    const double prepare_s = timer.seconds();
    constexpr double kPrepared = 0.5;
    if (on_progress) on_progress(kPrepared);
    uint64_t patches = 0, triangles = 0;
    int max_level = 0;
    for (const Instance& instance : prepared->instances) {
        const Surface& surface = prepared->surfaces[instance.surface];
        if (surface.has_displacement) {
            patches += surface.patch_count();
            max_level = std::max(max_level, instance.levels->max_level());
            continue;
        }
        for (const Quad quad : surface.quads) triangles += quad.is_triangle() ? 1 : 2;
    }
    Statistics statistics;
    RenderSettings on_cpu = settings;
    on_cpu.device.engine = EngineKind::cpu;
    make_engine(prepared, on_cpu)->add_statistics(statistics);
    const auto add_bytes = [&](const char* name, uint64_t bytes, const char* remark) {
        result.facts.push_back(
            {name, fmt::format("{} bytes{}", bytes, remark), {{"", double(bytes), "bytes"}}});
    };
    result.facts.push_back(make_count("patches", patches));
    result.facts.push_back(make_count("triangles", triangles));
    result.facts.push_back(
        {"finest_level", fmt::format("{}", max_level), {{"", double(max_level), "level"}}});
    add_bytes("geometry", statistics.geometry_bytes, "");
    add_bytes("structures", statistics.structures_bytes, "");
    count_scene(*prepared, statistics);
    add_bytes("map_texels", statistics.displacement_bytes, " with their bounds and copies");
    add_bytes("tessellated", estimate_tessellation(*prepared).peak_bytes, " at the levels of this view");
    result.facts.push_back(
        estimate_time(prepared, prepare_s, settings, make_part(on_progress, kPrepared, 1)));
    for (size_t k = scene.warnings.size(); k < prepared->warnings.size(); ++k)
        add_warning(result.findings, "W-SCENE", "{}", prepared->warnings[k]);
}

} // namespace

TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings) {
    validate_settings(settings);
    RenderSettings direct = settings;
    direct.surface.mode = SurfaceMode::direct;
    return estimate_tessellation(*prepare_scene(scene, direct, SceneOrigin::camera));
}

Inspection inspect_scene(const Scene& scene, const RenderSettings& settings,
                         const ProgressFunction& on_progress) {
    Inspection result;
    size_t displaced = 0;
    for (const Object& object : scene.objects) displaced += object.displacement != kNoIndex;
    result.facts = {
        make_count("meshes", scene.meshes.size()),
        {"objects",
         fmt::format("{}, {} displaced", scene.objects.size(), displaced),
         {{"", double(scene.objects.size()), "count"}, {"displaced", double(displaced), "count"}}},
        make_count("maps", scene.displacements.size()),
        {"lights",
         fmt::format("{}{}", scene.lights.size(), scene.environment ? " and an environment" : ""),
         {{"", double(scene.lights.size()), "count"},
          {"environments", scene.environment ? 1.0 : 0.0, "count"}}}};
    for (const std::string& warning : scene.warnings) add_warning(result.findings, "W-READ", "{}", warning);
    try {
        validate_scene(scene);
        const std::set<Pair> pairs = list_displaced(scene);
        ProgressCounter steps(make_part(on_progress, 0, 0.5), pairs.size() + scene.displacements.size());
        describe_meshes(scene, pairs, steps, result);
        describe_maps(scene, pairs, steps, result);
        describe_cost(scene, settings, make_part(on_progress, 0.5, 1), result);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        add_error(result.findings, "E-SCENE", "{}", error.what());
    }
    return result;
}

} // namespace relief
