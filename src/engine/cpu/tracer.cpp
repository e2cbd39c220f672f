#include "engine/cpu/tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "base/timer.h"
#include "engine/cpu/kernels.h"
#include "engine/scene_trees.h"
#include "relief/error.h"

namespace relief::cpu {

namespace {

/// One batch of a kind in so many measures how much of its time goes into patches; the clock would cost too
/// much in all of them.
constexpr uint64_t kTimedBatchInterval = 32;

/// Corners of the micro-triangle (u, v) lies in, object space: a triangle's own, or those of a cell of the
/// patch.
struct MicroTriangle {
    Vec3f corner[3];
    float weight_b, weight_c; ///< barycentric, of corners 1 and 2
    float uv_area;            ///< in the patch's (u, v)
};

/// `samples` is null on a surface without displacement.
MicroTriangle make_micro_triangle(const Surface& surface, const PatchSamples* samples,
                                  const PatchLevels& levels, const TraceHit& hit) {
    const float side = float(1u << levels.patch);
    const float x = std::clamp(hit.u * side - float(hit.i), 0.0f, 1.0f);
    const float y = std::clamp(hit.v * side - float(hit.j), 0.0f, 1.0f);
    MicroTriangle triangle;
    const Quad& quad = surface.quads[hit.patch];
    if (samples) {
        const auto vertex = [&](uint32_t i, uint32_t j) {
            return evaluate_vertex(*samples, levels, hit.i + i, hit.j + j);
        };
        triangle.corner[0] = vertex(0, 0);
        triangle.corner[1] = hit.is_upper ? vertex(1, 1) : vertex(1, 0);
        triangle.corner[2] = hit.is_upper ? vertex(0, 1) : vertex(1, 1);
    } else {
        triangle.corner[0] = surface.positions[quad.vertex[0]];
        triangle.corner[1] = surface.positions[quad.vertex[hit.is_upper ? 2 : 1]];
        triangle.corner[2] = surface.positions[quad.vertex[hit.is_upper ? 3 : 2]];
    }
    // Lower: P = P00 + x-y of P10 + y of P11; upper: x of P11 + y-x of P01.
    triangle.weight_b = hit.is_upper ? x : std::max(x - y, 0.0f);
    triangle.weight_c = hit.is_upper ? std::max(y - x, 0.0f) : y;
    triangle.uv_area = quad.is_triangle() ? 1.0f : 0.5f / (side * side);
    return triangle;
}

float largest_coordinate(const Vec3f& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// A point is interpolated between corners and transformed, and the ray that leaves it is transformed back:
/// each step errs by a few units in the last place of the largest number that it adds up.
float bound_position_error(const Affine& world_from_object, const MicroTriangle& triangle,
                           const Vec3f& position) {
    constexpr float kUnits = 32 * 0x1p-24f;
    float corner = 0, row = 0;
    for (const Vec3f& p : triangle.corner) corner = std::max(corner, largest_coordinate(p));
    for (const Vec3f& r : world_from_object.rows)
        row = std::max(row, std::fabs(r.x) + std::fabs(r.y) + std::fabs(r.z));
    return kUnits *
           (row * corner + largest_coordinate(world_from_object.translation) + largest_coordinate(position));
}

/// (i, j, is_upper) of the cell that holds hit.u, hit.v; on a triangle (u, v) is folded into v <= u.
void locate_cell(bool is_triangle, uint32_t side, TraceHit& hit) {
    if (is_triangle && hit.v > hit.u) std::swap(hit.u, hit.v);
    const float x = std::clamp(hit.u, 0.0f, 1.0f) * float(side),
                y = std::clamp(hit.v, 0.0f, 1.0f) * float(side);
    hit.i = uint16_t(std::min(uint32_t(x), side - 1));
    hit.j = uint16_t(std::min(uint32_t(y), side - 1));
    hit.is_upper = !is_triangle && y - float(hit.j) > x - float(hit.i);
}

Vec2f interpolate_uv(const Surface& surface, uint32_t patch, float u, float v) {
    if (surface.uvs.empty()) return {};
    const Quad& quad = surface.quads[patch];
    const auto uv = [&](size_t k) { return surface.uvs[quad.vertex[k]]; };
    if (!surface.has_displacement) {
        // Two triangles: linear on each, as their positions are.
        return v <= u ? uv(0) * (1 - u) + uv(1) * (u - v) + uv(2) * v
                      : uv(0) * (1 - v) + uv(2) * u + uv(3) * (v - u);
    }
    return (uv(0) * (1 - u) + uv(1) * u) * (1 - v) + (uv(3) * (1 - u) + uv(2) * u) * v;
}

TraceHit locate_hit(const PreparedScene& scene, uint32_t instance, uint32_t patch, const Vec2f& uv,
                    uint32_t bias) {
    const Instance& placed = scene.instances[instance];
    TraceHit hit;
    hit.instance = instance, hit.patch = patch;
    hit.u = uv.x, hit.v = uv.y;
    hit.bias = uint8_t(bias);
    const PatchLevels levels = placed.levels->at(patch).biased(bias);
    hit.levels = pack_levels(levels);
    locate_cell(scene.surfaces[placed.surface].quads[patch].is_triangle(), 1u << levels.patch, hit);
    return hit;
}

/// Nothing on a surface without displacement.
std::optional<PatchSamples> unpack_patch(const PreparedScene& scene, const TraceHit& hit) {
    const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
    return surface.has_displacement ? std::optional<PatchSamples>(std::in_place, surface, hit.patch)
                                    : std::nullopt;
}

/// The same through a cache; null on a surface without displacement.
const PatchSamples* find_samples(const PreparedScene& scene, const TraceHit& hit,
                                 PatchSamplesCache& patches) {
    const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
    return surface.has_displacement ? &patches.get(surface, hit.patch) : nullptr;
}

/// Position, facet and area; `samples` is null on a surface without displacement.
SurfacePoint make_facet_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const PatchLevels levels = unpack_levels(hit.levels);
    const MicroTriangle triangle = make_micro_triangle(surface, samples, levels, hit);
    const Vec3f &a = triangle.corner[0], &b = triangle.corner[1], &c = triangle.corner[2];

    SurfacePoint point;
    point.instance = hit.instance, point.patch = hit.patch;
    const Vec3f local =
        a * (1 - triangle.weight_b - triangle.weight_c) + b * triangle.weight_b + c * triangle.weight_c;
    point.position = transform_point(instance.world_from_object, local);
    const Vec3f edge_b = transform_vector(instance.world_from_object, b - a);
    const Vec3f edge_c = transform_vector(instance.world_from_object, c - a);
    const Vec3f area = cross(edge_b, edge_c) * (instance.is_mirrored ? -1.0f : 1.0f);
    point.geometric_normal = normalize(area);
    point.area_per_uv = 0.5f * length(area) / triangle.uv_area;
    point.position_error = bound_position_error(instance.world_from_object, triangle, point.position);
    return point;
}

/// The same with shading normal and uv.
SurfacePoint make_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const int level = unpack_levels(hit.levels).patch;
    SurfacePoint point = make_facet_point(scene, hit, samples);
    const Vec3f smooth = samples ? compute_shading_normal(surface, *samples, hit.patch, level, hit.u, hit.v)
                                 : compute_shading_normal(surface, hit.patch, level, hit.u, hit.v);
    point.shading_normal = normalize(transform_normal(instance.object_from_world, smooth));
    if (dot(point.shading_normal, point.shading_normal) == 0) point.shading_normal = point.geometric_normal;
    if (dot(point.shading_normal, point.geometric_normal) < 0) point.shading_normal = -point.shading_normal;
    point.uv = interpolate_uv(surface, hit.patch, hit.u, hit.v);
    return point;
}

} // namespace

struct Tracer::Implementation {
    const Kernels* kernels = nullptr;
    std::vector<WideBvh> surface_trees;
    WideBvh instance_tree;
    std::unique_ptr<BottomCache> cache;
    SceneView view;

    /// `cast` is the place in TraceContext::casts.
    template <class Trace> void trace_batch(size_t cast, size_t rays, const Trace& trace) const {
        TraceContext& context = cache->acquire();
        if (context.casts.size() <= cast) context.casts.resize(cast + 1);
        context.is_timed = context.casts[cast].batches % kTimedBatchInterval == 0;
        const Timer timer;
        const TraceCounters before = context.counters;
        try {
            trace(context);
        } catch (...) {
            cache->release(context);
            throw;
        }
        const double built = context.counters.bottom_build_s - before.bottom_build_s;
        const double seconds = timer.seconds() - built;
        context.casts[cast].add({1, rays, context.counters.pairs_emitted - before.pairs_emitted, built,
                                 seconds, context.is_timed ? seconds : 0,
                                 context.counters.sampled_bottom_s - before.sampled_bottom_s});
        cache->release(context);
    }

    void add_casts(Statistics& statistics) const {
        const std::vector<CastCounters> casts = cache->sum_casts();
        for (size_t k = 0; k < casts.size(); ++k) {
            const CastCounters& c = casts[k];
            if (c.rays == 0) continue;
            const double share = c.sampled_trace_s > 0 ? c.sampled_bottom_s / c.sampled_trace_s : 0;
            const CastStatistics cast{
                int(k / 2), k % 2 == 1,       c.rays,           c.pairs, c.trace_s * (1 - share),
                0,          c.bottom_build_s, c.trace_s * share};
            statistics.casts.push_back(cast);
            statistics.top_traversal_s += cast.top_traversal_s;
            statistics.bottom_build_s += cast.bottom_build_s;
            statistics.bottom_traversal_s += cast.bottom_traversal_s;
        }
    }
};

Tracer::Tracer(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings)
    : scene_(std::move(scene)), implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.kernels = find_kernels(settings.isa);
    if (!self.kernels)
        throw Error(ErrorKind::device_missing, {"this machine or build lacks the instruction set asked for",
                                                "", "`relief devices` lists those that work"});
    std::vector<Box> boxes;
    for (const Surface& surface : scene_->surfaces) {
        self.surface_trees.push_back(make_wide_bvh(build_surface_bvh(surface)));
        boxes.push_back(self.surface_trees.back().bounds);
    }
    self.instance_tree = make_wide_bvh(build_instance_bvh(*scene_, boxes));
    self.cache = std::make_unique<BottomCache>(settings.bottom_cache_bytes);
    const float pixel =
        float(2 * std::tan(scene_->camera.fov_degrees * std::numbers::pi / 360) / scene_->height);
    self.view = {scene_->instances.data(),
                 scene_->surfaces.data(),
                 self.surface_trees.data(),
                 &self.instance_tree,
                 self.cache.get(),
                 settings.leaf,
                 settings.lod,
                 settings.pixel_error * pixel};
}

Tracer::~Tracer() = default;

void Tracer::closest_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth) const {
    implementation_->trace_batch(2 * size_t(depth), rays.size(), [&](TraceContext& context) {
        implementation_->kernels->closest_hits(implementation_->view, context, rays.data(), hits.data(),
                                               rays.size());
    });
}

void Tracer::any_hits(std::span<const TraceRay> rays, std::span<uint8_t> occluded, int depth) const {
    implementation_->trace_batch(2 * size_t(depth) + 1, rays.size(), [&](TraceContext& context) {
        implementation_->kernels->any_hits(implementation_->view, context, rays.data(), occluded.data(),
                                           rays.size());
    });
}

SurfacePoint Tracer::make_surface_point(const TraceHit& hit) const {
    const std::optional<PatchSamples> samples = unpack_patch(*scene_, hit);
    return make_point(*scene_, hit, samples ? &*samples : nullptr);
}

SurfacePoint Tracer::make_surface_point(const TraceHit& hit, PatchSamplesCache& patches) const {
    return make_point(*scene_, hit, find_samples(*scene_, hit, patches));
}

SurfacePoint Tracer::evaluate_point(uint32_t instance, uint32_t patch, Vec2f uv, uint32_t bias) const {
    const TraceHit hit = locate_hit(*scene_, instance, patch, uv, bias);
    const std::optional<PatchSamples> samples = unpack_patch(*scene_, hit);
    return make_facet_point(*scene_, hit, samples ? &*samples : nullptr);
}

SurfacePoint Tracer::evaluate_point(uint32_t instance, uint32_t patch, Vec2f uv, uint32_t bias,
                                    PatchSamplesCache& patches) const {
    const TraceHit hit = locate_hit(*scene_, instance, patch, uv, bias);
    return make_facet_point(*scene_, hit, find_samples(*scene_, hit, patches));
}

Vec3f Tracer::offset_origin(const SurfacePoint& point, const Vec3f& direction) const {
    const float side = dot(direction, point.geometric_normal) < 0 ? -1.0f : 1.0f;
    return point.position + point.geometric_normal * (side * point.position_error);
}

void Tracer::add_statistics(Statistics& statistics) const {
    const Implementation& self = *implementation_;
    statistics.isa = self.kernels->name;
    const TraceCounters counters = self.cache->sum_counters();
    statistics.pairs_emitted += counters.pairs_emitted, statistics.pairs_with_hit += counters.pairs_with_hit;
    statistics.bottom_built += counters.built, statistics.bottom_reused += counters.reused;
    statistics.bottom_levels.resize(kTileLevel + 1);
    for (int level = 0; level <= kTileLevel; ++level)
        statistics.bottom_levels[size_t(level)] += counters.built_at_level[level];
    self.add_casts(statistics);
    statistics.structures_bytes += self.instance_tree.byte_count();
    for (const WideBvh& tree : self.surface_trees) statistics.structures_bytes += tree.byte_count();
    statistics.bottom_cache_bytes += self.cache->peak_byte_count();
    for (const Surface& surface : scene_->surfaces) statistics.geometry_bytes += surface.geometry_bytes();
    for (const Instance& instance : scene_->instances)
        statistics.geometry_bytes += sizeof(Instance) + instance.levels->byte_count();
}

} // namespace relief::cpu
