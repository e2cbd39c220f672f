#include "relief/triangle_probe.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "base/timer.h"
#include "engine/cpu/tracer.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Displaced patches alone see a ray's bias, and packets are of one bias: with two in turn, rays of a mesh
/// without displacement go alone and meet the same surface.
constexpr uint32_t kBiasesOfSingleRays = 2;

Scene make_scene(const Mesh& mesh) {
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.objects.push_back({"mesh", 0, kNoIndex, kNoIndex, {}});
    return scene;
}

} // namespace

struct TriangleProbe::Implementation {
    RenderSettings settings;
    std::shared_ptr<const PreparedScene> scene;
    std::unique_ptr<cpu::Tracer> tracer;
};

TriangleProbe::TriangleProbe(const Mesh& mesh, Isa isa)
    : implementation_(std::make_unique<Implementation>()) {
    if (std::any_of(mesh.face_sizes.begin(), mesh.face_sizes.end(), [](uint32_t size) { return size != 3; }))
        throw Error(ErrorKind::bad_input, {"the mesh has faces that are no triangles", mesh.name,
                                           "cut its faces into triangles before"});
    Implementation& self = *implementation_;
    self.settings.isa = isa;
    self.settings.bottom_cache_bytes = 0;
    self.settings.structure = StructureKind::bvh;
    self.settings.traversal = TraversalKind::wide;
    with_threads(1, [&] {
        self.scene = prepare_scene(make_scene(mesh), self.settings);
        self.tracer = std::make_unique<cpu::Tracer>(self.scene, self.settings);
    });
}

TriangleProbe::~TriangleProbe() = default;

double TriangleProbe::measure_build() const {
    double seconds = 0;
    with_threads(1, [&] {
        const Timer timer;
        const cpu::Tracer tracer(implementation_->scene, implementation_->settings);
        seconds = timer.seconds();
    });
    return seconds;
}

TriangleRun TriangleProbe::trace(std::span<const Ray> rays, RayGrouping grouping) const {
    std::vector<cpu::TraceRay> traced;
    for (const Ray& ray : rays) {
        const uint32_t bias =
            grouping == RayGrouping::single ? uint32_t(traced.size()) % kBiasesOfSingleRays : 0;
        traced.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max, bias});
    }
    std::vector<cpu::TraceHit> found(rays.size());
    TriangleRun run;
    const Timer timer;
    implementation_->tracer->closest_hits(traced, found);
    run.seconds = timer.seconds();
    for (const cpu::TraceHit& hit : found) run.hits.push_back({hit.t, hit.patch});
    return run;
}

uint64_t TriangleProbe::structures_bytes() const {
    Statistics statistics;
    implementation_->tracer->add_statistics(statistics);
    return statistics.structures_bytes;
}

} // namespace relief
