// What a scene is, what it costs as it is and what it would cost tessellated.
#include <algorithm>
#include <memory>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/mesh_statistics.h"
#include "api/make_engine.h"
#include "api/picture_report.h"
#include "base/timer.h"
#include "film/film.h"
#include "inspect/facts.h"
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

bool has_all_textures(const Displacement& map) {
    return !map.tiles.empty() && std::all_of(map.tiles.begin(), map.tiles.end(), [](const MapTile& tile) {
        return tile.texture && tile.texture->width > 0 && tile.texture->height > 0;
    });
}

/// Maps, each with the first mesh that it is used on.
void describe_maps(const Scene& scene, const std::set<Pair>& pairs, Inspection& result) {
    for (uint32_t index = 0; index < scene.displacements.size(); ++index) {
        const Displacement& map = scene.displacements[index];
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

void describe_meshes(const Scene& scene, const std::set<Pair>& pairs, Inspection& result) {
    std::set<uint32_t> displaced;
    for (const auto& [map, mesh] : pairs) {
        if (displaced.insert(mesh).second)
            result.facts.push_back({fmt::format("mesh.{}.base", scene.meshes.at(mesh).name),
                                    describe_base(scene.meshes.at(mesh)),
                                    {}});
        add_mesh_findings(scene.meshes.at(mesh), &scene.displacements.at(map), result);
    }
    for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
        if (displaced.count(mesh) == 0) add_mesh_findings(scene.meshes[mesh], nullptr, result);
}

/// Times samples of a part of a picture.
class TrialRender {
  public:
    TrialRender(const std::shared_ptr<const PreparedScene>& prepared, const RenderSettings& settings)
        : settings_(settings) {
        settings_.image.spp = 1;
        settings_.device.engine = EngineKind::cpu;
        engine_ = make_engine(prepared, settings_);
        groups_ = std::max(1, (settings.image.height + kBands * kRows - 1) / (kBands * kRows));
        while (std::gcd(stride_, groups_) != 1) ++stride_;
    }

    int group_count() const { return groups_; }
    /// Seconds of one sample of each pixel in a group of bands of rows, spread over the picture; full width,
    /// so that all threads have work. Groups [0, group_count) make up about the whole.
    double time_group(int group) {
        const Timer timer;
        for (int band = 0; band < kBands; ++band) {
            // Far from the group before, so that its trees do not serve this one more than others.
            const int slot = band * groups_ + int((int64_t(group) * stride_) % groups_);
            const int y0 = slot * kRows, y1 = std::min(settings_.image.height, y0 + kRows);
            if (y0 >= y1) continue;
            Film film(settings_.image.width, settings_.image.height, {0, y0, settings_.image.width, y1}, {});
            engine_->render(film, nullptr);
        }
        return timer.seconds();
    }

  private:
    static constexpr int kBands = 8, kRows = 4;
    RenderSettings settings_;
    std::unique_ptr<Engine> engine_;
    int groups_ = 1;
    int stride_ = 7; ///< has no factor in common with groups_
};

/// What a render would take: groups of rows are rendered for about a second, and the rest is taken to be like
/// the last of them, whose trees are mostly made.
Fact estimate_time(const std::shared_ptr<const PreparedScene>& prepared, double prepare_s,
                   const RenderSettings& settings) {
    constexpr double kBudget_s = 1;
    const Timer timer;
    TrialRender trial(prepared, settings);
    const double ready_s = prepare_s + timer.seconds();
    double first_s = 0, last_s = 0;
    int done = 0;
    while (done < trial.group_count() && (done == 0 || first_s < kBudget_s)) {
        last_s = trial.time_group(done++);
        first_s += last_s;
    }
    first_s += last_s * (trial.group_count() - done);
    const double next_s = trial.time_group(0) * trial.group_count();
    const double all_s = ready_s + first_s + next_s * (settings.image.spp - 1);
    return {"time",
            fmt::format("about {:.2g} s to be ready, {:.2g} s for the first sample, {:.3g} s for all {} at "
                        "{}x{} on the CPU; measured on {} of {} parts of the picture",
                        ready_s, first_s, all_s, settings.image.spp, settings.image.width,
                        settings.image.height, done, trial.group_count()),
            {{"", all_s, "s"},
             {"ready", ready_s, "s"},
             {"first_sample", first_s, "s"},
             {"samples", double(settings.image.spp), "count"}}};
}

void describe_cost(const Scene& scene, const RenderSettings& settings, Inspection& result) {
    const Timer timer;
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    const double prepare_s = timer.seconds();
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
    result.facts.push_back(estimate_time(prepared, prepare_s, settings));
    for (size_t k = scene.warnings.size(); k < prepared->warnings.size(); ++k)
        result.findings.push_back({Severity::warning, "W-SCENE", prepared->warnings[k]});
}

} // namespace

TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings) {
    validate_settings(settings);
    RenderSettings direct = settings;
    direct.surface.mode = SurfaceMode::direct;
    return estimate_tessellation(*prepare_scene(scene, direct));
}

Inspection inspect_scene(const Scene& scene, const RenderSettings& settings) {
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
    for (const std::string& warning : scene.warnings)
        result.findings.push_back({Severity::warning, "W-READ", warning});
    try {
        validate_scene(scene);
        const std::set<Pair> pairs = list_displaced(scene);
        describe_meshes(scene, pairs, result);
        describe_maps(scene, pairs, result);
        describe_cost(scene, settings, result);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        result.findings.push_back({Severity::error, "E-SCENE", error.what()});
    }
    return result;
}

} // namespace relief
