// Rays that travel together through all instances, up to 256: what they ask, and what they have met so far.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "cpu/traversal/camera_rays-inl.h"
#include "cpu/traversal/ray-inl.h"
#include "cpu/traversal/ray_lanes-inl.h"
#include "formulas/camera.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

inline constexpr uint32_t kBundleSize = 256, kGroupSize = 16, kGroupCount = kBundleSize / kGroupSize;
inline constexpr uint32_t kRangeCount = kGroupCount + 1;

struct HitLog;

/// What a ray may have found instead of a hit of the log: nothing, or what lies in its place already.
inline constexpr uint32_t kWritten = 0xfffffffe, kNothing = 0xffffffff;

/// What the spaces of all objects share: the rays, and what they met so far.
struct BundleRays {
    cpu::TraceHit* hits; ///< those of rays with kWritten are there
    HitLog* log;
    uint32_t count, lod_bias;
    bool has_one_origin;
    Vec3f origin;                            ///< of all, or of the first
    Box origins;                             ///< about all, once pad_inactive_lanes has been
    alignas(64) uint32_t found[kBundleSize]; ///< number in the log, kWritten or kNothing
    alignas(64) float t[kBundleSize];        ///< of the nearest hit, or the ray's t_max
    alignas(64) float t_min[kBundleSize];
    alignas(64) float direction[3][kBundleSize];
    alignas(64) float from[3][kBundleSize]; ///< origins, unless they are one

    Vec3f direction_of(uint32_t k) const { return {direction[0][k], direction[1][k], direction[2][k]}; }
    Vec3f origin_of(uint32_t k) const {
        return has_one_origin ? origin : Vec3f{from[0][k], from[1][k], from[2][k]};
    }
    LaneMask group_mask(uint32_t group) const {
        const uint32_t first = group * kGroupSize;
        return count >= first + kGroupSize ? 0xffffu : count > first ? (1u << (count - first)) - 1 : 0u;
    }
};

/// Writes what a bundle keeps of sixteen rays, repeated where there are fewer. Returns those that may be in
/// one with others of the lod_bias: can_hit.
RELIEF_INLINE LaneMask load_group(const RayLanes& lanes, size_t at, BundleRays& rays) {
    for (int k = 0; k < 3; ++k) {
        lanes.direction[k].store(rays.direction[k] + at);
        if (!rays.has_one_origin) lanes.origin[k].store(rays.from[k] + at);
    }
    lanes.t_min.store(rays.t_min + at), lanes.t_max.store(rays.t + at);
    return lanes.of_lod_bias & lanes.can_hit();
}

/// Takes rays at the front, at most kBundleSize, while find_fitting(lanes) has them.
template <class FindFitting>
RELIEF_INLINE void load_front(const cpu::TraceRay* world, size_t count, BundleRays& rays,
                              FindFitting find_fitting) {
    rays.count = 0, rays.lod_bias = world[0].lod_bias, rays.origin = world[0].origin;
    const uint32_t most = uint32_t(HWY_MIN(count, size_t(kBundleSize)));
    while (rays.count < most) {
        const uint32_t left = HWY_MIN(most - rays.count, kGroupSize);
        const RayLanes lanes(world + rays.count, left, rays.lod_bias);
        const LaneMask fits = load_group(lanes, rays.count, rays) & find_fitting(lanes);
        const uint32_t taken = hwy::Num0BitsBelowLS1Bit_Nonzero32(~fits);
        rays.count += taken;
        if (taken < kGroupSize) break;
    }
}

/// Takes the rays at the front that leave one point together.
inline void load_frustum(const cpu::TraceRay* world, size_t count, BundleRays& rays) {
    const float origin[3] = {world[0].origin.x, world[0].origin.y, world[0].origin.z};
    rays.has_one_origin = true;
    load_front(world, count, rays, [&](const RayLanes& lanes) {
        return equal(lanes.origin[0], Lanes16(origin[0])) & equal(lanes.origin[1], Lanes16(origin[1])) &
               equal(lanes.origin[2], Lanes16(origin[2]));
    });
}

/// Of the angle between a ray of a beam and the first one: some ten degrees.
inline constexpr float kLeastBeamSquaredCosine = 0.97f;

/// Takes the rays at the front that go about the way of the first, and nothing before their origins.
inline void load_beam(const cpu::TraceRay* world, size_t count, BundleRays& rays) {
    const Vec3f first = normalize(world[0].direction);
    const Lanes16 least(kLeastBeamSquaredCosine);
    rays.has_one_origin = false;
    load_front(world, count, rays, [&](const RayLanes& lanes) {
        const Lanes16(&d)[3] = lanes.direction;
        const Lanes16 projection = dot_lanes(d, first);
        return less(Lanes16(0.0f), projection) & less_equal(Lanes16(0.0f), lanes.t_min) &
               less(least * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), projection * projection);
    });
}

/// Aims pinhole rays through up to kBundleSize positions; writes them to `written` unless it is null.
inline void load_frustum(const scalar::CameraFrame& camera, const Vec2f* positions, uint32_t count,
                         cpu::TraceRay* written, BundleRays& rays) {
    const WideCamera wide_camera(camera);
    const Lanes16 start(0.0f), end(std::numeric_limits<float>::infinity());
    rays.count = count, rays.lod_bias = 0, rays.has_one_origin = true, rays.origin = camera.origin;
    for (uint32_t at = 0; at < count; at += kGroupSize) {
        const uint32_t size = HWY_MIN(count - at, kGroupSize);
        const wide::Vec3 direction = wide_camera.aim(positions + at, size);
        direction.x.store(rays.direction[0] + at), direction.y.store(rays.direction[1] + at);
        direction.z.store(rays.direction[2] + at);
        start.store(rays.t_min + at), end.store(rays.t + at);
        if (written) store_rays(camera.origin, direction, size, written + at);
    }
}

/// Places behind the last ray repeat it and reach nothing.
inline void pad_inactive_lanes(BundleRays& rays) {
    for (uint32_t last = rays.count - 1, k = rays.count; k < kBundleSize; ++k) {
        rays.t[k] = 0, rays.t_min[k] = rays.t_min[last];
        for (float* direction : rays.direction) direction[k] = direction[last];
        if (rays.has_one_origin) continue;
        for (float* from : rays.from) from[k] = from[last];
    }
    rays.origins = {rays.origin, rays.origin};
    if (rays.has_one_origin) return;
    for (int axis = 0; axis < 3; ++axis) {
        const float* const from = rays.from[axis];
        Lanes16 least = Lanes16::load(from), greatest = least;
        for (uint32_t at = kGroupSize; at < rays.count; at += kGroupSize)
            least = min(least, Lanes16::load(from + at)), greatest = max(greatest, Lanes16::load(from + at));
        set_component(rays.origins.lower, axis, reduce_min(least));
        set_component(rays.origins.upper, axis, reduce_max(greatest));
    }
}

/// Whether a ray begins so far away from an object that it is moved there by itself.
RELIEF_INLINE bool is_any_far_away(const BundleRays& rays, const Instance& placed) {
    return is_far_away(rays.origins.lower, placed) || is_far_away(rays.origins.upper, placed);
}

/// Width of the box of the origins over the distance of neighbours; of a tile of 16 x 16 pixels some 16.
inline constexpr float kWidestBeam = 64;

/// The same of rays in any order: two. Rays through a lens are in any order there, but its width is narrow.
inline constexpr float kWidthInOrder = 4;

/// False where rays begin on things that lie far apart: a beam about them would hold all that is between.
/// Also where most neighbours begin in one place, and where a beam that is not `narrow` has rays in any
/// order. After pad_inactive_lanes.
inline bool are_neighbours_close(const BundleRays& rays, float narrow) {
    constexpr uint32_t kSamples = 15; // of the distances of neighbours, for their median
    std::array<float, kSamples> distance;
    for (uint32_t n = 0; n < kSamples; ++n) {
        const uint32_t k = n * (rays.count - 1) / kSamples;
        distance[n] = length(rays.origin_of(k + 1) - rays.origin_of(k));
    }
    std::nth_element(distance.begin(), distance.begin() + kSamples / 2, distance.end());
    const float median = distance[kSamples / 2];
    const Vec3f extent = rays.origins.extent();
    const float width = std::fmax(std::fmax(extent.x, extent.y), extent.z);
    return width <= kWidestBeam * median && (width <= narrow || width >= kWidthInOrder * median);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
