#include "cpu/shading/surface_points.h"

#include <algorithm>
#include <array>

#include "cpu/shading/texture_place.h"
#include "formulas/cell_place.h"
#include "formulas/local_start.h"
#include "formulas/mips.h"

namespace relief::cpu {

namespace {

/// Corners of a micro-triangle, object space.
using Corners = std::array<Vec3f, 3>;

/// A triangle's own, or those of a cell of the patch; `samples` is null on a surface without displacement.
Corners make_corners(const Surface& surface, const PatchSamples* samples, const PatchLevels& levels,
                     const TraceHit& hit) {
    if (!samples) {
        const Quad quad = surface.quads[hit.patch];
        return {surface.position(quad.vertex[0]), surface.position(quad.vertex[hit.is_upper ? 2 : 1]),
                surface.position(quad.vertex[hit.is_upper ? 3 : 2])};
    }
    const auto vertex = [&](uint32_t i, uint32_t j) {
        return evaluate_vertex(*samples, levels, hit.i + i, hit.j + j);
    };
    return {vertex(0, 0), hit.is_upper ? vertex(1, 1) : vertex(1, 0),
            hit.is_upper ? vertex(0, 1) : vertex(1, 1)};
}

float bound_position_error(const Instance& instance, const Corners& corners, const Vec3f& position) {
    const Affine& world_from_object = instance.world_from_object;
    float corner = 0, row = 0;
    for (const Vec3f& p : corners) corner = std::max(corner, scalar::largest_coordinate(p));
    for (const Vec3f& r : world_from_object.rows) row = std::max(row, scalar::sum_magnitudes(r));
    return scalar::bound_position_error(
        corner, row, scalar::largest_coordinate(world_from_object.translation),
        scalar::largest_coordinate(position), scalar::share_of_place(instance.object_space.origin));
}

Vec2f interpolate_uv(const Surface& surface, uint32_t patch, float u, float v) {
    if (surface.uvs.empty()) return {};
    const Quad quad = surface.quads[patch];
    const auto uv = [&](size_t k) { return surface.uvs[quad.vertex[k]]; };
    return blend_corner_uvs(surface, {uv(0), uv(1), uv(2), uv(3)}, {u, v});
}

/// Hits of one key are on polygons of a surface, or on patches that read one image: one SIMD call.
constexpr uint32_t kAlone = kNoIndex;
constexpr size_t kFewPolygons = 4; ///< of less than these one after another is faster

uint32_t make_key(const PreparedScene& scene, const TraceHit& hit) {
    const uint32_t index = scene.instances[hit.instance].surface;
    const Surface& surface = scene.surfaces[index];
    if (!can_batch_points(surface, hit.patch)) return kAlone;
    if (index >= 1u << 21) return kAlone;
    if (!surface.has_displacement) return index << 11;
    const uint32_t mip = scalar::packed_mip(surface.packed_mips(hit.patch), scalar::kMipInside);
    return index << 11 | mip << 8 | surface.tile(surface.quads[hit.patch].vertex[0]);
}

/// As std::sort of numbers whose lower halves rise; in one pass where their upper halves are of few kinds.
void sort_kinds(std::vector<uint64_t>& keys, std::vector<uint64_t>& sorted, std::vector<uint8_t>& kinds) {
    constexpr size_t kMostKinds = 16;
    struct Kind {
        uint64_t value;
        uint32_t count, next;
    };
    std::array<Kind, kMostKinds> found;
    size_t kind_count = 0, last = 0;
    kinds.resize(keys.size());
    for (size_t k = 0; k < keys.size(); ++k) {
        const uint64_t value = keys[k] >> 32;
        if (kind_count == 0 || found[last].value != value) {
            for (last = 0; last < kind_count && found[last].value != value;) ++last;
            if (last == kMostKinds) return std::sort(keys.begin(), keys.end());
            if (last == kind_count) found[kind_count++] = {value, 0, 0};
        }
        ++found[last].count;
        kinds[k] = uint8_t(last);
    }
    for (size_t a = 0; a < kind_count; ++a)
        for (size_t b = 0; b < kind_count; ++b)
            found[a].next += found[b].value < found[a].value ? found[b].count : 0;
    sorted.resize(keys.size());
    for (size_t k = 0; k < keys.size(); ++k) sorted[found[kinds[k]].next++] = keys[k];
    keys.swap(sorted);
}

/// The same through a cache; null on a surface without displacement.
const PatchSamples* find_samples(const PreparedScene& scene, const TraceHit& hit,
                                 PatchSamplesCache& patches) {
    const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
    return surface.has_displacement ? &patches.get(surface, hit.patch) : nullptr;
}

} // namespace

TraceHit locate_hit(const PreparedScene& scene, uint32_t instance, uint32_t patch, const Vec2f& uv,
                    uint32_t lod_bias) {
    const Instance& placed = scene.instances[instance];
    TraceHit hit;
    hit.instance = instance, hit.patch = patch;
    hit.lod_bias = uint8_t(lod_bias);
    const PatchLevels levels = placed.levels->at(patch).biased(lod_bias);
    hit.levels = pack_levels(levels);
    const bool is_triangle = scene.surfaces[placed.surface].quads[patch].is_triangle();
    const scalar::CellPlace place = scalar::locate_cell(is_triangle, 1u << levels.patch, uv.x, uv.y);
    hit.u = place.u, hit.v = place.v;
    hit.i = uint16_t(place.i), hit.j = uint16_t(place.j), hit.is_upper = place.is_upper;
    return hit;
}

std::array<Vec3f, 3> find_corners(const PreparedScene& scene, const TraceHit& hit,
                                  const PatchSamples* samples) {
    const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
    return make_corners(surface, samples, unpack_levels(hit.levels), hit);
}

std::optional<PatchSamples> unpack_patch(const PreparedScene& scene, const TraceHit& hit) {
    const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
    return surface.has_displacement ? std::optional<PatchSamples>(std::in_place, surface, hit.patch)
                                    : std::nullopt;
}

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
    const Vec3f edge_b = transform_vector(world_from_object, b - a);
    const Vec3f edge_c = transform_vector(world_from_object, c - a);
    const float uv_area = scalar::triangle_uv_area(surface.quads[hit.patch].is_triangle(), side);
    const scalar::TrianglePoint triangle = scalar::make_triangle_point(
        transform_point(world_from_object, scalar::blend_corners(a, b, c, weights)), edge_b, edge_c,
        instance.is_mirrored ? -1.0f : 1.0f, uv_area);
    point.geometric_normal = triangle.normal;
    point.area_per_uv = triangle.area_per_uv;
    point.position_error = bound_position_error(instance, corners, triangle.position);
    point.position = scalar::leave_edges(triangle.position, point.position_error, weights, edge_b, edge_c,
                                         2 * triangle.area_per_uv * uv_area);
    return point;
}

Vec2f find_uv(const PreparedScene& scene, const TraceHit& hit) {
    return interpolate_uv(scene.surfaces[scene.instances[hit.instance].surface], hit.patch, hit.u, hit.v);
}

SurfacePoint make_shading_point(const PreparedScene& scene, const TraceHit& hit,
                                const PatchSamples* samples) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const int level = unpack_levels(hit.levels).patch;
    SurfacePoint point = make_cell_point(scene, hit, samples);
    const Vec3f smooth = samples ? compute_shading_normal(surface, *samples, hit.patch, level, hit.u, hit.v)
                                 : compute_shading_normal(surface, hit.patch, level, hit.u, hit.v);
    point.shading_normal = scalar::orient_shading_normal(
        transform_normal(instance.object_space.from_origin, smooth), point.geometric_normal);
    point.uv = interpolate_uv(surface, hit.patch, hit.u, hit.v);
    return point;
}

void make_points(const PreparedScene& scene, const ShadingKernels& kernels, std::span<const TraceHit> hits,
                 std::span<SurfacePoint> points, PointScratch& scratch) {
    std::vector<uint64_t>& keys = scratch.keys;
    keys.clear();
    for (size_t k = 0; k < hits.size(); ++k) keys.push_back(uint64_t(make_key(scene, hits[k])) << 32 | k);
    if (!std::is_sorted(keys.begin(), keys.end())) sort_kinds(keys, scratch.sorted, scratch.kinds);
    scratch.order.clear();
    for (const uint64_t key : keys) scratch.order.push_back(uint32_t(key));
    for (size_t first = 0, last; first < keys.size(); first = last) {
        const uint32_t key = uint32_t(keys[first] >> 32);
        for (last = first + 1; last < keys.size() && uint32_t(keys[last] >> 32) == key;) ++last;
        const TraceHit& any = hits[scratch.order[first]];
        const Surface& surface = scene.surfaces[scene.instances[any.instance].surface];
        if (key != kAlone && (surface.has_displacement || last - first >= kFewPolygons)) {
            const auto make = surface.has_displacement ? kernels.make_points : kernels.make_polygon_points;
            make({scene, scratch.patches, hits.data(), scratch.order.data() + first, last - first,
                  points.data()});
            continue;
        }
        for (size_t n = first; n < last; ++n) {
            const TraceHit& hit = hits[scratch.order[n]];
            points[scratch.order[n]] =
                make_shading_point(scene, hit, find_samples(scene, hit, scratch.patches));
        }
    }
}

} // namespace relief::cpu
