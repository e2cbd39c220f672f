// What a scene is, what it costs as it is and what it would cost tessellated.
#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "engine/engine.h"
#include "engine/prepared_scene.h"
#include "engine/tessellate.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "validate_settings.h"

namespace relief {

namespace {

void describe_maps(const Scene& scene, Inspection& result) {
    for (const Displacement& displacement : scene.displacements) {
        for (const MapTile& tile : displacement.tiles) {
            if (!tile.texture) continue;
            const Inspection map = inspect_texture(*tile.texture);
            const std::string name =
                displacement.is_udim ? fmt::format("{}.{}", displacement.name, tile.udim) : displacement.name;
            for (const Fact& fact : map.facts)
                result.facts.push_back({fmt::format("map.{}.{}", name, fact.name), fact.value});
            for (const Finding& finding : map.findings) {
                // A height map is what this displacement asks for.
                const bool is_meant = displacement.type == DisplacementType::height &&
                                      (finding.code == "W-1CH" || finding.code == "W-GRAY");
                if (!is_meant)
                    result.findings.push_back({finding.severity, finding.code,
                                               fmt::format("displacement '{}': {}", name, finding.text)});
            }
        }
    }
}

/// Meshes by their objects: uvs and quads matter where a map is applied only.
void describe_meshes(const Scene& scene, Inspection& result) {
    std::set<uint32_t> displaced;
    for (const Object& object : scene.objects) {
        if (object.displacement != kNoIndex) displaced.insert(object.mesh);
    }
    for (uint32_t index = 0; index < scene.meshes.size(); ++index) {
        for (const Finding& finding : inspect_mesh(scene.meshes[index]).findings) {
            if (finding.severity != Severity::error && displaced.count(index) == 0) continue;
            result.findings.push_back({finding.severity, finding.code,
                                       fmt::format("mesh '{}': {}", scene.meshes[index].name, finding.text)});
        }
    }
}

void describe_cost(const Scene& scene, const RenderSettings& settings, Inspection& result) {
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    uint64_t patches = 0, triangles = 0;
    int max_level = 0;
    for (const Instance& instance : prepared->instances) {
        const Surface& surface = prepared->surfaces[instance.surface];
        if (surface.has_displacement) {
            patches += surface.patch_count();
            max_level = std::max(max_level, instance.levels->max_level());
            continue;
        }
        for (const Quad& quad : surface.quads) triangles += quad.is_triangle() ? 1 : 2;
    }
    Statistics statistics;
    make_cpu_engine(prepared, settings)->add_statistics(statistics);
    const auto add = [&](const char* name, std::string value) {
        result.facts.push_back({name, std::move(value)});
    };
    add("patches", fmt::format("{}", patches));
    add("triangles", fmt::format("{}", triangles));
    add("finest_level", fmt::format("{}", max_level));
    add("geometry", fmt::format("{} bytes", statistics.geometry_bytes));
    add("structures", fmt::format("{} bytes", statistics.structures_bytes));
    add("tessellated",
        fmt::format("{} bytes at the levels of this view", estimate_tessellation(*prepared).peak_bytes));
}

} // namespace

TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings) {
    validate_settings(settings);
    RenderSettings direct = settings;
    direct.surface = SurfaceMode::direct;
    return estimate_tessellation(*prepare_scene(scene, direct));
}

Inspection inspect_scene(const Scene& scene, const RenderSettings& settings) {
    Inspection result;
    size_t displaced = 0;
    for (const Object& object : scene.objects) displaced += object.displacement != kNoIndex;
    result.facts = {
        {"meshes", fmt::format("{}", scene.meshes.size())},
        {"objects", fmt::format("{}, {} displaced", scene.objects.size(), displaced)},
        {"maps", fmt::format("{}", scene.displacements.size())},
        {"lights", fmt::format("{}{}", scene.lights.size(), scene.environment ? " and an environment" : "")}};
    for (const std::string& warning : scene.warnings)
        result.findings.push_back({Severity::warning, "W-READ", warning});
    describe_meshes(scene, result);
    describe_maps(scene, result);
    try {
        describe_cost(scene, settings, result);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        result.findings.push_back({Severity::error, "E-SCENE", error.what()});
    }
    return result;
}

} // namespace relief
