#include "bench/triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>

#include "bench/embree_scene.h"
#include "bench/machine.h"
#include "bench/tree_rays.h"
#include "lab/tracer_probe.h"

namespace relief::bench {

namespace {

constexpr double kTraceGoal = 1.2, kBuildGoal = 1.5;

/// Distance tolerance of equal hits: relative, below distance 1 absolute.
constexpr double kSameDistance = 1e-5;

bool has_area(const Vec3f& p, const Vec3f& q, const Vec3f& r) {
    const double ux = double(q.x) - p.x, uy = double(q.y) - p.y, uz = double(q.z) - p.z;
    const double vx = double(r.x) - p.x, vy = double(r.y) - p.y, vz = double(r.z) - p.z;
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return x * x + y * y + z * z > 0;
}

/// Triangulates faces as fans, without degenerate triangles.
Mesh cut_into_triangles(const Mesh& mesh) {
    Mesh result;
    result.name = mesh.name, result.source = mesh.source;
    result.positions = mesh.positions;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const uint32_t* corner = mesh.position_indices.data() + first;
        for (uint32_t k = 2; k < size; ++k) {
            const std::array<uint32_t, 3> fan = {corner[0], corner[k - 1], corner[k]};
            if (!has_area(mesh.positions[fan[0]], mesh.positions[fan[1]], mesh.positions[fan[2]])) continue;
            result.face_sizes.push_back(3);
            result.position_indices.insert(result.position_indices.end(), fan.begin(), fan.end());
        }
        first += size;
    }
    return result;
}

/// Rays that hit another triangle at another distance.
size_t count_differences(std::span<const TreeHit> a, std::span<const TreeHit> b) {
    size_t count = 0;
    for (size_t k = 0; k < a.size(); ++k) {
        const bool is_same = a[k].primitive == b[k].primitive ||
                             std::fabs(double(a[k].t) - b[k].t) <= kSameDistance * std::max(1.0f, a[k].t);
        count += is_same ? 0 : 1;
    }
    return count;
}

double get_median(const Value& part) { return part["median"].get<double>(); }

Scene make_bare_scene(const Mesh& mesh) {
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.objects.push_back({mesh.name, 0, kNoIndex, kNoIndex, {}});
    return scene;
}

RenderSettings make_settings(const TrianglesOptions& options) {
    RenderSettings settings;
    settings.image.width = options.width, settings.image.height = options.height;
    settings.device.isa = options.isa;
    settings.device.threads = 1;
    settings.surface.cache_bytes = 0;
    return settings;
}

/// Both programs with a tree over one mesh.
struct Contest {
    const Mesh& mesh;
    EmbreeScene fast, robust;
    TracerProbe relief;

    Contest(const Mesh& m, const TrianglesOptions& options)
        : mesh(m),
          fast(m, EmbreeMode::fast),
          robust(m, EmbreeMode::robust),
          relief(make_bare_scene(m), make_settings(options)) {}

    double time_embree(const EmbreeScene& scene, const RaySet& set) const {
        return scene.trace(set.rays, {set.kind, 1, false}).seconds;
    }
    double time_relief(const RaySet& set, RayGrouping grouping) const {
        return relief.trace(set.rays, set.kind, grouping).seconds;
    }
    std::vector<TreeHit> find_hits(const RaySet& set, RayGrouping grouping) const {
        std::vector<TreeHit> hits;
        for (const ProbeHit& hit : relief.trace(set.rays, set.kind, grouping).hits)
            hits.push_back({hit.t, hit.patch});
        return hits;
    }
};

Value measure_rays(const Contest& contest, const RaySet& set, int runs) {
    const std::vector<TreeHit> fast = contest.fast.trace(set.rays, {}).hits;
    const std::vector<TreeHit> robust = contest.robust.trace(set.rays, {}).hits;
    const std::vector<TreeHit> single = contest.find_hits(set, RayGrouping::single);
    const std::vector<TreeHit> packets = contest.find_hits(set, RayGrouping::packets);
    const auto seconds = time_in_turn({[&] { return contest.time_embree(contest.fast, set); },
                                       [&] { return contest.time_embree(contest.robust, set); },
                                       [&] { return contest.time_relief(set, RayGrouping::single); },
                                       [&] { return contest.time_relief(set, RayGrouping::packets); }},
                                      runs);
    Value cast = {{"rays", set.name},
                  {"count", set.rays.size()},
                  {"hits", std::count_if(single.begin(), single.end(),
                                         [](const TreeHit& hit) { return hit.primitive != kNoIndex; })},
                  {"differences_from_embree", count_differences(single, fast)},
                  {"differences_from_embree_robust", count_differences(single, robust)},
                  {"differences_of_packets", count_differences(single, packets)},
                  {"embree_s", summarize(seconds[0])},
                  {"embree_robust_s", summarize(seconds[1])},
                  {"relief_single_s", summarize(seconds[2])},
                  {"relief_packets_s", summarize(seconds[3])}};
    cast["ratio"] = get_median(cast["relief_single_s"]) / get_median(cast["embree_s"]);
    cast["ratio_robust"] = get_median(cast["relief_single_s"]) / get_median(cast["embree_robust_s"]);
    cast["ratio_packets"] = get_median(cast["relief_packets_s"]) / get_median(cast["embree_s"]);
    return cast;
}

Value measure_build(const Contest& contest, int runs) {
    const auto seconds = time_in_turn({[&] { return EmbreeScene(contest.mesh, EmbreeMode::fast).build_s(); },
                                       [&] { return contest.relief.measure_build(); }},
                                      runs);
    Value build = {{"embree_s", summarize(seconds[0])}, {"relief_s", summarize(seconds[1])}};
    build["ratio"] = get_median(build["relief_s"]) / get_median(build["embree_s"]);
    build["relief_bytes"] = contest.relief.count().structures_bytes;
    return build;
}

Value measure_mesh(const Scene& scene, const TrianglesOptions& options, const Report& report) {
    const Mesh mesh = cut_into_triangles(scene.meshes.at(0));
    report(fmt::format("{}: {} triangles", mesh.name, mesh.face_sizes.size()));
    const Contest contest(mesh, options);
    const RaySet primary{"primary", HitKind::closest, contest.relief.make_camera_rays(scene.camera), {}};
    const std::vector<TreeHit> hits = contest.fast.trace(primary.rays, {}).hits;
    const std::vector<RaySet> secondary = make_secondary_rays(mesh, primary, hits, {0, 1, 0});
    const RaySet& diffuse = *std::find_if(secondary.begin(), secondary.end(),
                                          [](const RaySet& set) { return set.name == "diffuse"; });
    Value result = {{"name", mesh.name}, {"triangles", mesh.face_sizes.size()}};
    result["build"] = measure_build(contest, options.runs);
    result["casts"] = Value::list(
        {measure_rays(contest, primary, options.runs), measure_rays(contest, diffuse, options.runs)});
    return result;
}

void add_goal(Value& goals, const std::string& name, double goal, double reached) {
    goals.push_back({{"name", name},
                     {"goal", goal},
                     {"reached", reached},
                     {"unit", "of Embree's time"},
                     {"met", reached <= goal}});
}

} // namespace

TrianglesOptions make_quick_options(TrianglesOptions options) {
    options.runs = 1;
    options.width = 64, options.height = 36;
    options.detail = MeshDetail::reduced;
    return options;
}

Value run_triangles(const TrianglesOptions& options, const Report& report) {
    Value result = {
        {"suite", "triangles"},
        {"build", describe_build()},
        {"machine", describe_machine()},
        {"settings", {{"runs", options.runs}, {"width", options.width}, {"height", options.height}}},
        {"meshes", Value::list()},
        {"goals", Value::list()}};
    std::vector<Scene> scenes = {make_structure_scene("body", options.detail),
                                 make_structure_scene("hall", options.detail)};
    scenes.insert(scenes.end(), options.meshes.begin(), options.meshes.end());
    for (const Scene& scene : scenes) {
        const Value measured = measure_mesh(scene, options, report);
        const std::string name = measured["name"].get<std::string>();
        for (const Value& cast : measured["casts"])
            add_goal(result["goals"],
                     fmt::format("{}: {} rays, one at a time", name, cast["rays"].get<std::string>()),
                     kTraceGoal, cast["ratio"].get<double>());
        add_goal(result["goals"], name + ": build", kBuildGoal, measured["build"]["ratio"].get<double>());
        result["meshes"].push_back(measured);
    }
    return result;
}

} // namespace relief::bench
