#include "lab/tracer_probe.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/timer.h"
#include "cpu/path_tracer.h"
#include "cpu/shading/shading_kernels.h"
#include "cpu/tracer.h"
#include "cpu/traversal/kernels.h"
#include "engine/picture_windows.h"
#include "formulas/camera.h"
#include "formulas/path.h"
#include "formulas/sobol.h"
#include "formulas/surface_point.h"
#include "prepare/camera_frame.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr int kPacketEdge = 4;
constexpr size_t kBatchSize = 1024; ///< rays that a worker takes at once, as cpu_engine does

/// What a worker needs for a batch, kept from one to the next.
struct BatchBuffers {
    std::vector<cpu::TraceRay> rays;
    std::vector<cpu::TraceHit> hits;
};

/// The middles of all pixels, tile after tile, in the order of packets.
std::vector<Vec2f> list_centres(const std::vector<Window>& tiles) {
    std::vector<Vec2f> centres;
    for (const Window& tile : tiles)
        for (const Window& packet : cut_into_windows(tile, kPacketEdge))
            for (int y = packet.y0; y < packet.y1; ++y)
                for (int x = packet.x0; x < packet.x1; ++x)
                    centres.push_back({float(x) + 0.5f, float(y) + 0.5f});
    return centres;
}

void aim_rays(const cpu::ShadingKernels& kernels, const scalar::CameraFrame& frame,
              std::span<const Vec2f> centres, std::vector<cpu::TraceRay>& rays) {
    rays.resize(centres.size());
    if (frame.aperture_radius == 0) {
        kernels.aim_rays(frame, centres.data(), centres.size(), rays.data());
        return;
    }
    for (size_t k = 0; k < rays.size(); ++k) {
        const uint32_t seed = scalar::make_pixel_seed(0, uint32_t(centres[k].x), uint32_t(centres[k].y));
        const scalar::CameraRay ray =
            scalar::make_camera_ray(frame, centres[k], scalar::sobol_pair(seed, 0, scalar::kLensPair));
        rays[k] = {};
        rays[k].origin = ray.origin, rays[k].direction = ray.direction;
    }
}

ProbeHit make_probe_hit(const cpu::TraceHit& found) {
    return {found.t, found.instance, found.patch, {found.u, found.v}, found.i, found.j, found.is_upper != 0};
}

void count_hits(ProbeRun& run) {
    run.hit_count = 0;
    for (const ProbeHit& hit : run.hits) run.hit_count += hit.is_hit() ? 1 : 0;
    for (const uint8_t occluded : run.occluded) run.hit_count += occluded;
}

} // namespace

struct TracerProbe::Implementation {
    RenderSettings settings;
    std::shared_ptr<const PreparedScene> scene;
    std::unique_ptr<cpu::Tracer> tracer;
    const cpu::Kernels* kernels = nullptr;
    ProbePreparation preparation;
    std::vector<uint32_t> first_patches; ///< of each instance, one entry more than instances
    std::vector<Window> tiles;
    std::vector<Vec2f> centres;        ///< of pixels, tile after tile
    std::vector<BatchBuffers> buffers; ///< one a worker

    const Surface& surface_of(uint32_t instance) const {
        return scene->surfaces[scene->instances[instance].surface];
    }

    void number_patches() {
        first_patches.assign(1, 0);
        for (uint32_t k = 0; k < scene->instances.size(); ++k)
            first_patches.push_back(first_patches.back() +
                                    (surface_of(k).has_displacement ? surface_of(k).patch_count() : 0));
    }

    /// (instance, patch of its surface).
    std::pair<uint32_t, uint32_t> find_patch(uint32_t number) const {
        const auto next = std::upper_bound(first_patches.begin(), first_patches.end(), number);
        const uint32_t instance = uint32_t(next - first_patches.begin()) - 1;
        return {instance, number - first_patches[instance]};
    }

    template <class Body> void run(const Body& body) const { with_threads(settings.device.threads, body); }

    void make_tracer() { tracer = std::make_unique<cpu::Tracer>(scene, settings); }

    cpu::TraceHit restore(const ProbeHit& hit) const {
        cpu::TraceHit found;
        found.t = hit.t, found.instance = hit.instance, found.patch = hit.patch;
        found.u = hit.uv.x, found.v = hit.uv.y, found.i = hit.i, found.j = hit.j;
        found.is_upper = hit.is_upper;
        found.levels = pack_levels(scene->instances[hit.instance].levels->at(hit.patch));
        return found;
    }

    void store_hits(size_t first, const std::vector<cpu::TraceHit>& found, ProbeRun& result) const {
        for (size_t k = 0; k < found.size(); ++k) result.hits[first + k] = make_probe_hit(found[k]);
    }

    void trace_tile(const scalar::CameraFrame& frame, const Window& tile, ProbeRun& result) {
        BatchBuffers& buffer = buffers[size_t(current_thread_index())];
        // All rows of tiles above, and the tiles to the left.
        const size_t first =
            size_t(tile.y0) * size_t(settings.image.width) + size_t(tile.y1 - tile.y0) * size_t(tile.x0);
        const std::span<const Vec2f> positions = std::span(centres).subspan(first, count_pixels(tile));
        buffer.hits.resize(positions.size());
        if (frame.aperture_radius == 0) {
            tracer->camera_hits(frame, positions, {}, buffer.hits);
        } else {
            aim_rays(tracer->shading_kernels(), frame, positions, buffer.rays);
            tracer->closest_hits(buffer.rays, buffer.hits);
        }
        store_hits(first, buffer.hits, result);
    }

    void trace_batch(std::span<const Ray> rays, size_t begin, RayGrouping grouping, HitKind kind,
                     ProbeRun& result) {
        BatchBuffers& buffer = buffers[size_t(current_thread_index())];
        // Displaced patches alone see a ray's LOD bias, and packets are of one LOD bias: with two in turn,
        // rays of a scene without displacement go alone and meet the same surface.
        const uint32_t largest_bias = grouping == RayGrouping::single ? 1 : 0;
        buffer.rays.resize(rays.size());
        // Field by field into place: a ray that is put together elsewhere first waits for its own stores.
        for (size_t k = 0; k < rays.size(); ++k) {
            cpu::TraceRay& ray = buffer.rays[k];
            ray.origin = rays[k].origin, ray.t_min = rays[k].t_min;
            ray.direction = rays[k].direction, ray.t_max = rays[k].t_max;
            ray.lod_bias = uint32_t(k) & largest_bias;
        }
        if (kind == HitKind::any) {
            tracer->any_hits(buffer.rays, std::span(result.occluded).subspan(begin, rays.size()));
            return;
        }
        buffer.hits.resize(buffer.rays.size());
        tracer->closest_hits(buffer.rays, buffer.hits);
        store_hits(begin, buffer.hits, result);
    }
};

TracerProbe::TracerProbe(Scene scene, const RenderSettings& settings)
    : implementation_(std::make_unique<Implementation>()) {
    validate_settings(settings);
    if (settings.device.engine != EngineKind::cpu)
        throw Error(ErrorKind::usage, {"the probe is of the CPU engine", "", "engine = EngineKind::cpu"});
    Implementation& self = *implementation_;
    self.settings = settings;
    self.kernels = cpu::find_kernels(settings.device.isa);
    self.run([&] {
        Timer timer;
        self.scene = prepare_scene(std::move(scene), settings);
        self.preparation.surfaces_s = timer.seconds();
        timer.restart();
        self.make_tracer();
        self.preparation.trees_s = timer.seconds();
        self.buffers.resize(size_t(thread_count()));
    });
    self.number_patches();
    self.tiles = cut_into_windows({0, 0, settings.image.width, settings.image.height}, cpu::kTileEdge);
    self.centres = list_centres(self.tiles);
}

TracerProbe::~TracerProbe() = default;

const ProbePreparation& TracerProbe::preparation() const { return implementation_->preparation; }

double TracerProbe::measure_build() const {
    double seconds = 0;
    implementation_->run([&] {
        const Timer timer;
        const cpu::Tracer tracer(implementation_->scene, implementation_->settings);
        seconds = timer.seconds();
    });
    return seconds;
}

void TracerProbe::empty_cache() {
    implementation_->run([&] { implementation_->make_tracer(); });
}

std::vector<Ray> TracerProbe::make_camera_rays(const Camera& camera) const {
    const Implementation& self = *implementation_;
    PreparedScene view;
    view.camera = camera;
    view.width = self.settings.image.width, view.height = self.settings.image.height;
    const scalar::CameraFrame frame = make_camera_frame(view);
    std::vector<cpu::TraceRay> aimed;
    aim_rays(self.tracer->shading_kernels(), frame, self.centres, aimed);
    std::vector<Ray> rays(aimed.size());
    for (size_t k = 0; k < rays.size(); ++k)
        rays[k].origin = aimed[k].origin, rays[k].direction = aimed[k].direction;
    return rays;
}

ProbeRun TracerProbe::trace_camera(ProbeRun room) const {
    Implementation& self = *implementation_;
    ProbeRun result = std::move(room);
    result.occluded.clear();
    result.hits.resize(size_t(self.settings.image.width) * size_t(self.settings.image.height));
    const scalar::CameraFrame frame = make_camera_frame(*self.scene);
    self.run([&] {
        self.tracer->rebuild_if_worthwhile();
        const Timer timer;
        parallel_for("probe_camera", self.tiles.size(), 1, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) self.trace_tile(frame, self.tiles[k], result);
        });
        result.seconds = timer.seconds();
    });
    count_hits(result);
    return result;
}

ProbeRun TracerProbe::trace(std::span<const Ray> rays, HitKind kind, RayGrouping grouping,
                            ProbeRun room) const {
    Implementation& self = *implementation_;
    if (grouping == RayGrouping::single && self.first_patches.back() > 0)
        throw Error(ErrorKind::usage, {"rays go alone in scenes without displacement only", "",
                                       "RayGrouping::packets leaves the choice to the engine"});
    ProbeRun result = std::move(room);
    result.hits.resize(kind == HitKind::closest ? rays.size() : 0);
    result.occluded.resize(kind == HitKind::any ? rays.size() : 0);
    self.run([&] {
        self.tracer->rebuild_if_worthwhile();
        const Timer timer;
        parallel_for("probe_rays", rays.size(), kBatchSize, [&](size_t begin, size_t end) {
            self.trace_batch(rays.subspan(begin, end - begin), begin, grouping, kind, result);
        });
        result.seconds = timer.seconds();
    });
    count_hits(result);
    return result;
}

ProbePoint TracerProbe::find_point(const ProbeHit& hit) const {
    const cpu::SurfacePoint point =
        implementation_->tracer->make_surface_point(implementation_->restore(hit));
    return {point.position, point.geometric_normal, point.position_error};
}

std::array<Vec3f, 3> TracerProbe::find_corners(const ProbeHit& hit) const {
    const Implementation& self = *implementation_;
    const Surface& surface = self.surface_of(hit.instance);
    const Instance& instance = self.scene->instances[hit.instance];
    const PatchLevels levels = instance.levels->at(hit.patch);
    const auto corner = [&](uint32_t i, uint32_t j, size_t quad_corner) {
        const Vec3f p = surface.has_displacement
                            ? evaluate_vertex(surface, hit.patch, levels, hit.i + i, hit.j + j)
                            : surface.position(surface.quads[hit.patch].vertex[quad_corner]);
        return transform_point(instance.world_from_object, p);
    };
    if (hit.is_upper) return {corner(0, 0, 0), corner(1, 1, 2), corner(0, 1, 3)};
    return {corner(0, 0, 0), corner(1, 0, 1), corner(1, 1, 2)};
}

Ray TracerProbe::leave(const ProbePoint& point, const Vec3f& direction) const {
    Ray ray;
    ray.origin = scalar::offset_origin(point.position, point.normal, point.position_error, direction);
    ray.direction = direction;
    return ray;
}

uint32_t TracerProbe::patch_count() const { return implementation_->first_patches.back(); }

int TracerProbe::patch_level(uint32_t patch) const {
    const auto [instance, index] = implementation_->find_patch(patch);
    return implementation_->scene->instances[instance].levels->at(index).patch;
}

void TracerProbe::evaluate_patch(uint32_t patch, std::span<Vec3f> vertices) const {
    const Implementation& self = *implementation_;
    const auto [number, index] = self.find_patch(patch);
    const Instance& instance = self.scene->instances[number];
    const PatchLevels levels = instance.levels->at(index);
    const uint32_t side = 1u << levels.patch, step = std::min(side, 1u << cpu::kTileLevel);
    const size_t stride = side + 1;
    if (vertices.size() != stride * stride)
        throw Error(ErrorKind::usage, {"the room is not for the vertices of the patch", "", ""});
    for (uint32_t y = 0; y < side; y += step)
        for (uint32_t x = 0; x < side; x += step)
            self.kernels->evaluate_cells(self.surface_of(number), {index, levels, x, y, step},
                                         vertices.data() + y * stride + x, stride);
    if (instance.world_from_object == Affine{}) return;
    for (Vec3f& vertex : vertices) vertex = transform_point(instance.world_from_object, vertex);
}

std::vector<std::array<Vec3f, 3>> TracerProbe::list_plain_triangles() const {
    const Implementation& self = *implementation_;
    std::vector<std::array<Vec3f, 3>> triangles;
    for (uint32_t k = 0; k < self.scene->instances.size(); ++k) {
        const Surface& surface = self.surface_of(k);
        if (surface.has_displacement) continue;
        ProbeHit place;
        place.instance = k;
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            place.patch = patch;
            place.is_upper = false;
            triangles.push_back(find_corners(place));
            place.is_upper = true;
            if (!surface.quads[patch].is_triangle()) triangles.push_back(find_corners(place));
        }
    }
    return triangles;
}

ProbeCounts TracerProbe::count() const {
    const Implementation& self = *implementation_;
    Statistics statistics;
    self.tracer->add_statistics(statistics);
    ProbeCounts counts;
    counts.patches = patch_count();
    for (uint32_t patch = 0; patch < patch_count(); ++patch)
        counts.micro_quads += uint64_t(1) << (2 * patch_level(patch));
    for (uint32_t k = 0; k < self.scene->instances.size(); ++k)
        if (!self.surface_of(k).has_displacement)
            for (const Quad quad : self.surface_of(k).quads) counts.triangles += quad.is_triangle() ? 1 : 2;
    counts.geometry_bytes = statistics.geometry_bytes;
    counts.structures_bytes = statistics.structures_bytes;
    counts.plain_bytes = self.tracer->count_plain_bytes();
    for (size_t level = 0; level < statistics.bottom_levels.size(); ++level) {
        const uint64_t built = statistics.bottom_levels[level];
        counts.trees_built += built;
        counts.built_quads += built << (2 * level);
        counts.built_bytes += built * cpu::PatchTree::size_bytes(int(level));
    }
    counts.cache_bytes = statistics.bottom_cache_bytes;
    return counts;
}

std::string TracerProbe::isa() const { return implementation_->kernels->name; }

} // namespace relief
