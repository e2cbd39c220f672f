#include "bench/triangles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "bench/embree_scene.h"
#include "bench/machine.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kTraceGoal = 1.2, kBuildGoal = 1.5;

/// Distances this close count as one hit: relative, and below distance 1 absolute.
constexpr double kSameDistance = 1e-5;

struct Direction {
    double x, y, z;
};

Direction normalize(Direction d) {
    const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return {d.x / length, d.y / length, d.z / length};
}

Direction cross(const Direction& a, const Direction& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Row by row in tiles of 4 x 4, which packets like, as the path tracer's order does.
std::vector<Ray> make_primary_rays(const Camera& camera, int width, int height) {
    const Direction z = normalize({double(camera.to.x) - camera.from.x, double(camera.to.y) - camera.from.y,
                                   double(camera.to.z) - camera.from.z});
    const Direction x = normalize(cross(z, {camera.up.x, camera.up.y, camera.up.z})), y = cross(x, z);
    const double tangent = std::tan(camera.fov_degrees * std::numbers::pi / 360);
    std::vector<Ray> rays;
    for (int tile_y = 0; tile_y < height; tile_y += 4)
        for (int tile_x = 0; tile_x < width; tile_x += 4)
            for (int k = 0; k < 16; ++k) {
                const double sx = (2 * (tile_x + k % 4 + 0.5) - width) / height * tangent;
                const double sy = (height - 2 * (tile_y + k / 4 + 0.5)) / height * tangent;
                const Direction d = normalize(
                    {z.x + sx * x.x + sy * y.x, z.y + sx * x.y + sy * y.y, z.z + sx * x.z + sy * y.z});
                rays.push_back({camera.from, 0, {float(d.x), float(d.y), float(d.z)}});
            }
    return rays;
}

/// Two numbers in [0, 1) that depend on nothing but the ray's place (Wang's hash).
double draw(uint32_t place, uint32_t dimension) {
    uint32_t bits = place * 2 + dimension;
    bits = (bits ^ 61) ^ (bits >> 16);
    bits *= 9;
    bits ^= bits >> 4;
    bits *= 0x27d4eb2du;
    bits ^= bits >> 15;
    return bits * 0x1p-32;
}

/// A cosine-weighted bounce from every hit.
std::vector<Ray> make_diffuse_rays(std::span<const Ray> rays, const EmbreeRun& run) {
    std::vector<Ray> bounced;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (run.hits[k].triangle == kNoIndex) continue;
        const Ray& ray = rays[k];
        const double t = run.hits[k].t;
        Direction n = normalize({run.normals[k].x, run.normals[k].y, run.normals[k].z});
        if (n.x * ray.direction.x + n.y * ray.direction.y + n.z * ray.direction.z > 0) n = {-n.x, -n.y, -n.z};
        const double height = 2 * draw(uint32_t(k), 0) - 1,
                     angle = 2 * std::numbers::pi * draw(uint32_t(k), 1);
        const double around = std::sqrt(1 - height * height);
        const Direction d = normalize({n.x * 1.0001 + around * std::cos(angle),
                                       n.y * 1.0001 + around * std::sin(angle), n.z * 1.0001 + height});
        const double lift = 1e-4 * t;
        bounced.push_back({{float(ray.origin.x + t * ray.direction.x + lift * n.x),
                            float(ray.origin.y + t * ray.direction.y + lift * n.y),
                            float(ray.origin.z + t * ray.direction.z + lift * n.z)},
                           0,
                           {float(d.x), float(d.y), float(d.z)}});
    }
    return bounced;
}

/// Rays that met another triangle at another distance.
size_t count_differences(std::span<const TriangleHit> a, std::span<const TriangleHit> b) {
    size_t count = 0;
    for (size_t k = 0; k < a.size(); ++k) {
        const bool is_same = a[k].triangle == b[k].triangle ||
                             std::fabs(double(a[k].t) - b[k].t) <= kSameDistance * std::max(1.0f, a[k].t);
        count += is_same ? 0 : 1;
    }
    return count;
}

using Measures = std::vector<std::function<double()>>;

/// Each once to warm up, then all in turn; seconds of every run of each.
std::vector<std::vector<double>> time_in_turn(const Measures& measures, int runs) {
    std::vector<std::vector<double>> seconds(measures.size());
    for (int run = 0; run <= runs; ++run)
        for (size_t k = 0; k < measures.size(); ++k) {
            const double measured = measures[k]();
            if (run > 0) seconds[k].push_back(measured);
        }
    return seconds;
}

double get_median(const Json& part) { return part["median"].get<double>(); }

/// Both programs with the tree of one mesh.
struct Contest {
    const Mesh& mesh;
    EmbreeScene fast, robust;
    TriangleProbe relief;

    Contest(const Mesh& m, Isa isa)
        : mesh(m), fast(m, EmbreeMode::fast), robust(m, EmbreeMode::robust), relief(m, isa) {}
};

Json measure_rays(const Contest& contest, const char* kind, std::span<const Ray> rays, int runs) {
    const std::vector<TriangleHit> fast = contest.fast.trace(rays).hits;
    const std::vector<TriangleHit> robust = contest.robust.trace(rays).hits;
    const std::vector<TriangleHit> single = contest.relief.trace(rays, RayGrouping::single).hits;
    const std::vector<TriangleHit> packets = contest.relief.trace(rays, RayGrouping::packets).hits;
    const auto seconds = time_in_turn(
        {[&] { return contest.fast.trace(rays).seconds; }, [&] { return contest.robust.trace(rays).seconds; },
         [&] { return contest.relief.trace(rays, RayGrouping::single).seconds; },
         [&] { return contest.relief.trace(rays, RayGrouping::packets).seconds; }},
        runs);
    Json cast = {{"rays", kind},
                 {"count", rays.size()},
                 {"hits", std::count_if(single.begin(), single.end(),
                                        [](const TriangleHit& hit) { return hit.triangle != kNoIndex; })},
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

Json measure_build(const Contest& contest, int runs) {
    const auto seconds = time_in_turn({[&] { return EmbreeScene(contest.mesh, EmbreeMode::fast).build_s(); },
                                       [&] { return contest.relief.measure_build(); }},
                                      runs);
    Json build = {{"embree_s", summarize(seconds[0])}, {"relief_s", summarize(seconds[1])}};
    build["ratio"] = get_median(build["relief_s"]) / get_median(build["embree_s"]);
    build["relief_bytes"] = contest.relief.structures_bytes();
    return build;
}

Json measure_mesh(const TriangleMesh& mesh, const TrianglesOptions& options, const Report& report) {
    report(fmt::format("{}: {} triangles", mesh.name, mesh.mesh.face_sizes.size()));
    const Contest contest(mesh.mesh, options.isa);
    const std::vector<Ray> primary = make_primary_rays(mesh.camera, options.width, options.height);
    const std::vector<Ray> diffuse = make_diffuse_rays(primary, contest.fast.trace(primary));
    Json result = {{"name", mesh.name}, {"triangles", mesh.mesh.face_sizes.size()}};
    result["build"] = measure_build(contest, options.runs);
    result["casts"] = {measure_rays(contest, "primary", primary, options.runs),
                       measure_rays(contest, "diffuse", diffuse, options.runs)};
    return result;
}

void add_goal(Json& goals, const std::string& name, double goal, double reached) {
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
    options.detail = 0.02;
    return options;
}

Json run_triangles(const TrianglesOptions& options, const Report& report) {
    Json result = {
        {"suite", "triangles"},
        {"build", describe_build()},
        {"machine", describe_machine()},
        {"settings", {{"runs", options.runs}, {"width", options.width}, {"height", options.height}}},
        {"meshes", Json::array()},
        {"goals", Json::array()}};
    std::vector<TriangleMesh> meshes = {make_bumpy_body(std::max(2, int(76 * std::sqrt(options.detail)))),
                                        make_hall(options.detail)};
    meshes.insert(meshes.end(), options.meshes.begin(), options.meshes.end());
    for (const TriangleMesh& mesh : meshes) {
        const Json measured = measure_mesh(mesh, options, report);
        for (const Json& cast : measured["casts"])
            add_goal(result["goals"],
                     fmt::format("{}: {} rays, one at a time", mesh.name, cast["rays"].get<std::string>()),
                     kTraceGoal, cast["ratio"]);
        add_goal(result["goals"], mesh.name + ": build", kBuildGoal, measured["build"]["ratio"]);
        result["meshes"].push_back(measured);
    }
    return result;
}

std::vector<ReportFile> make_triangles_files(const Json& result) {
    std::string csv = "mesh,triangles,part,count,embree_s,embree_robust_s,relief_single_s,relief_packets_s,"
                      "ratio,differences\n";
    for (const Json& mesh : result["meshes"]) {
        const std::string start =
            fmt::format("{},{}", mesh["name"].get<std::string>(), mesh["triangles"].get<size_t>());
        const Json& build = mesh["build"];
        csv += fmt::format("{},build,,{:.6g},,{:.6g},,{:.4g},\n", start, get_median(build["embree_s"]),
                           get_median(build["relief_s"]), build["ratio"].get<double>());
        for (const Json& cast : mesh["casts"])
            csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{}\n", start,
                               cast["rays"].get<std::string>(), cast["count"].get<size_t>(),
                               get_median(cast["embree_s"]), get_median(cast["embree_robust_s"]),
                               get_median(cast["relief_single_s"]), get_median(cast["relief_packets_s"]),
                               cast["ratio"].get<double>(), cast["differences_from_embree"].get<size_t>());
    }
    return {{"triangles.json", result.dump(1) + "\n"}, {"triangles.csv", csv}};
}

} // namespace relief::bench
