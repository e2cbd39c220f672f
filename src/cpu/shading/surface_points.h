// From hits to points of the surface: one by one, which is the definition, or many at once by SIMD kernels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cpu/shading/shading_kernels.h"
#include "cpu/tracer.h"

namespace relief::cpu {

/// False where a SIMD kernel would need an exception: nothing to fetch, or a fetch beside the map.
inline bool can_batch_points(const Surface& surface, uint32_t patch) {
    if (!surface.has_displacement) return true;
    return surface.map.wrap != WrapMode::black && !surface.frames.empty() &&
           surface.tile(surface.quads[patch].vertex[0]) < surface.map.tiles.size();
}

/// The cell that holds a place of a patch on surface M_bias, as a hit.
TraceHit locate_hit(const PreparedScene& scene, uint32_t instance, uint32_t patch, const Vec2f& uv,
                    uint32_t lod_bias);

/// Nothing on a surface without displacement.
std::optional<PatchSamples> unpack_patch(const PreparedScene& scene, const TraceHit& hit);

/// Corners of the hit's micro-triangle (00, 10, 11 or 00, 11, 01), object space; without samples the polygon.
std::array<Vec3f, 3> find_corners(const PreparedScene& scene, const TraceHit& hit,
                                  const PatchSamples* samples);

/// Position, geometric normal and area; `samples` is null on a surface without displacement.
SurfacePoint make_cell_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples);
/// The same with shading normal and uv.
SurfacePoint make_shading_point(const PreparedScene& scene, const TraceHit& hit, const PatchSamples* samples);

Vec2f find_uv(const PreparedScene& scene, const TraceHit& hit);

/// Points of all hits, many at once where that can be; points[k] belongs to hits[k].
void make_points(const PreparedScene& scene, const ShadingKernels& kernels, std::span<const TraceHit> hits,
                 std::span<SurfacePoint> points, PointScratch& scratch);

} // namespace relief::cpu
