#include "engine/cpu/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "base/timer.h"
#include "engine/cpu/kernels.h"
#include "engine/cpu/tree_walks.h"
#include "engine/scene_trees.h"
#include "math/scalar.h"
#include "relief/error.h"

namespace relief::cpu {

namespace {

/// One batch of a kind in so many measures how much of its time goes into patches; the clock would cost too
/// much in all of them.
constexpr uint64_t kTimedBatchInterval = 32;

/// Corners of a micro-triangle, object space.
using Corners = std::array<Vec3f, 3>;

/// A triangle's own, or those of a cell of the patch; `samples` is null on a surface without displacement.
Corners make_corners(const Surface& surface, const PatchSamples* samples, const PatchLevels& levels,
                     const TraceHit& hit) {
    if (!samples) {
        const Quad& quad = surface.quads[hit.patch];
        return {surface.positions[quad.vertex[0]], surface.positions[quad.vertex[hit.is_upper ? 2 : 1]],
                surface.positions[quad.vertex[hit.is_upper ? 3 : 2]]};
    }
    const auto vertex = [&](uint32_t i, uint32_t j) {
        return evaluate_vertex(*samples, levels, hit.i + i, hit.j + j);
    };
    return {vertex(0, 0), hit.is_upper ? vertex(1, 1) : vertex(1, 0),
            hit.is_upper ? vertex(0, 1) : vertex(1, 1)};
}

float bound_position_error(const Affine& world_from_object, const Corners& corners, const Vec3f& position) {
    float corner = 0, row = 0;
    for (const Vec3f& p : corners) corner = std::max(corner, scalar::largest_coordinate(p));
    for (const Vec3f& r : world_from_object.rows) row = std::max(row, scalar::sum_magnitudes(r));
    return scalar::bound_position_error(corner, row,
                                        scalar::largest_coordinate(world_from_object.translation),
                                        scalar::largest_coordinate(position));
}

Vec2f interpolate_uv(const Surface& surface, uint32_t patch, float u, float v) {
    if (surface.uvs.empty()) return {};
    const Quad& quad = surface.quads[patch];
    const auto uv = [&](size_t k) { return surface.uvs[quad.vertex[k]]; };
    return surface.has_displacement ? scalar::blend_patch_uv(uv(0), uv(1), uv(2), uv(3), {u, v})
                                    : scalar::blend_polygon_uv(uv(0), uv(1), uv(2), uv(3), {u, v});
}

TraceHit locate_hit(const PreparedScene& scene, uint32_t instance, uint32_t patch, const Vec2f& uv,
                    uint32_t bias) {
    const Instance& placed = scene.instances[instance];
    TraceHit hit;
    hit.instance = instance, hit.patch = patch;
    hit.bias = uint8_t(bias);
    const PatchLevels levels = placed.levels->at(patch).biased(bias);
    hit.levels = pack_levels(levels);
    const bool is_triangle = scene.surfaces[placed.surface].quads[patch].is_triangle();
    const scalar::CellPlace place = scalar::locate_cell(is_triangle, 1u << levels.patch, uv.x, uv.y);
    hit.u = place.u, hit.v = place.v;
    hit.i = uint16_t(place.i), hit.j = uint16_t(place.j), hit.is_upper = place.is_upper;
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

/// Position, geometric normal and area; `samples` is null on a surface without displacement.
SurfacePoint make_cell_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const PatchLevels levels = unpack_levels(hit.levels);
    const Corners corners = make_corners(surface, samples, levels, hit);
    const auto& [a, b, c] = corners;
    const float side = float(1u << levels.patch);
    const scalar::CornerWeights weights =
        scalar::weigh_corners({hit.u, hit.v, hit.i, hit.j, hit.is_upper != 0}, side);

    SurfacePoint point;
    point.instance = hit.instance, point.patch = hit.patch;
    const Affine& world_from_object = instance.world_from_object;
    const scalar::TrianglePoint triangle = scalar::make_triangle_point(
        transform_point(world_from_object, scalar::blend_corners(a, b, c, weights)),
        transform_vector(world_from_object, b - a), transform_vector(world_from_object, c - a),
        instance.is_mirrored ? -1.0f : 1.0f,
        scalar::triangle_uv_area(surface.quads[hit.patch].is_triangle(), side));
    point.position = triangle.position;
    point.geometric_normal = triangle.normal;
    point.area_per_uv = triangle.area_per_uv;
    point.position_error = bound_position_error(world_from_object, corners, point.position);
    return point;
}

/// The same with shading normal and uv.
SurfacePoint make_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const int level = unpack_levels(hit.levels).patch;
    SurfacePoint point = make_cell_point(scene, hit, samples);
    const Vec3f smooth = samples ? compute_shading_normal(surface, *samples, hit.patch, level, hit.u, hit.v)
                                 : compute_shading_normal(surface, hit.patch, level, hit.u, hit.v);
    point.shading_normal = scalar::orient_shading_normal(transform_normal(instance.object_from_world, smooth),
                                                         point.geometric_normal);
    point.uv = interpolate_uv(surface, hit.patch, hit.u, hit.v);
    return point;
}

} // namespace

struct Tracer::Implementation {
    const Kernels* kernels = nullptr;
    WalkFunctions walk{}; ///< of a traversal asked for by name; null: the wide trees
    WalkTrees walk_trees;
    std::vector<WideBvh> surface_trees;
    std::vector<PolygonTree> polygon_trees;
    WideBvh instance_tree;
    std::unique_ptr<BottomCache> cache;
    SceneView view;

    void make_trees(const PreparedScene& scene, const RenderSettings& settings) {
        const TraversalKind traversal = choose_traversal(settings, EngineKind::cpu);
        if (traversal != TraversalKind::wide) {
            walk_trees = make_walk_trees(scene, settings.structure, traversal);
            walk = find_walk(traversal, walk_trees.depth);
            return;
        }
        std::vector<Box> boxes;
        for (const Surface& surface : scene.surfaces) {
            surface_trees.emplace_back(), polygon_trees.emplace_back();
            if (surface.has_displacement)
                surface_trees.back() = make_wide_bvh(build_surface_bvh(surface));
            else
                polygon_trees.back() = build_polygon_tree(surface);
            boxes.push_back(surface.has_displacement ? surface_trees.back().bounds
                                                     : polygon_trees.back().bounds);
        }
        instance_tree = make_wide_bvh(build_instance_bvh(scene, boxes));
    }

    WalkView walk_view() const { return {view, walk_trees, kernels->primitive}; }

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
    self.make_trees(*scene_, settings);
    self.cache = std::make_unique<BottomCache>(settings.bottom_cache_bytes);
    const float pixel =
        float(2 * std::tan(scene_->camera.fov_degrees * std::numbers::pi / 360) / scene_->height);
    self.view = {scene_->instances.data(),
                 scene_->surfaces.data(),
                 uint32_t(scene_->instances.size()),
                 self.surface_trees.data(),
                 self.polygon_trees.data(),
                 &self.instance_tree,
                 self.cache.get(),
                 settings.leaf,
                 settings.lod,
                 settings.pixel_error * pixel};
}

Tracer::~Tracer() = default;

void Tracer::closest_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth) const {
    implementation_->trace_batch(2 * size_t(depth), rays.size(), [&](TraceContext& context) {
        const Implementation& self = *implementation_;
        if (self.walk.closest_hits)
            self.walk.closest_hits(self.walk_view(), context, rays.data(), hits.data(), rays.size());
        else
            self.kernels->closest_hits(self.view, context, rays.data(), hits.data(), rays.size());
    });
}

void Tracer::any_hits(std::span<const TraceRay> rays, std::span<uint8_t> occluded, int depth) const {
    implementation_->trace_batch(2 * size_t(depth) + 1, rays.size(), [&](TraceContext& context) {
        const Implementation& self = *implementation_;
        if (self.walk.any_hits)
            self.walk.any_hits(self.walk_view(), context, rays.data(), occluded.data(), rays.size());
        else
            self.kernels->any_hits(self.view, context, rays.data(), occluded.data(), rays.size());
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
    return make_cell_point(*scene_, hit, samples ? &*samples : nullptr);
}

SurfacePoint Tracer::evaluate_point(uint32_t instance, uint32_t patch, Vec2f uv, uint32_t bias,
                                    PatchSamplesCache& patches) const {
    const TraceHit hit = locate_hit(*scene_, instance, patch, uv, bias);
    return make_cell_point(*scene_, hit, find_samples(*scene_, hit, patches));
}

Vec3f Tracer::offset_origin(const SurfacePoint& point, const Vec3f& direction) const {
    return scalar::offset_origin(point.position, point.geometric_normal, point.position_error, direction);
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
    statistics.structures_bytes += self.instance_tree.byte_count() + self.walk_trees.byte_count();
    for (const WideBvh& tree : self.surface_trees) statistics.structures_bytes += tree.byte_count();
    for (const PolygonTree& tree : self.polygon_trees) statistics.structures_bytes += tree.byte_count();
    statistics.bottom_cache_bytes += self.cache->peak_byte_count();
    for (const Surface& surface : scene_->surfaces) statistics.geometry_bytes += surface.geometry_bytes();
    for (const Instance& instance : scene_->instances)
        statistics.geometry_bytes += sizeof(Instance) + instance.levels->byte_count();
}

} // namespace relief::cpu
