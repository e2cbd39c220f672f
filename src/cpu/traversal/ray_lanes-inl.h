// Rays brought from memory into lanes.
#pragma once

#include <cstddef>
#include <cstring>

#include "cpu/tracer.h"
#include "formulas/lanes-inl.h"
#include "formulas/local_start.h"
#include "prepare/prepared_scene.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

template <size_t W> RELIEF_INLINE Lanes<W> dot_lanes(const Lanes<W> (&v)[3], const Vec3f& n) {
    return v[0] * Lanes<W>(n.x) + v[1] * Lanes<W>(n.y) + v[2] * Lanes<W>(n.z);
}

/// Sixteen rays in world space, a ray a lane: the last one again where there are fewer.
struct RayLanes {
    Lanes16 origin[3], direction[3], t_min, t_max;
    LaneMask of_lod_bias; ///< rays that are there, not repeated, and have the LOD bias asked for

    RELIEF_INLINE RayLanes(const cpu::TraceRay* rays, uint32_t count, uint32_t lod_bias) : of_lod_bias(0) {
        static_assert(offsetof(cpu::TraceRay, t_min) == 12 && offsetof(cpu::TraceRay, direction) == 16 &&
                      offsetof(cpu::TraceRay, t_max) == 28);
        LaneQuads starts, ends;
        for (uint32_t lane = 0; lane < 16; ++lane) {
            const cpu::TraceRay& ray = rays[HWY_MIN(lane, count - 1)];
            std::memcpy(starts.lane[lane], &ray.origin, 16);
            std::memcpy(ends.lane[lane], &ray.direction, 16);
            of_lod_bias |= LaneMask(lane < count && ray.lod_bias == lod_bias) << lane;
        }
        starts.transpose(origin[0], origin[1], origin[2], t_min);
        ends.transpose(direction[0], direction[1], direction[2], t_max);
    }

    /// is_far_away of each.
    RELIEF_INLINE LaneMask find_far_away(const Instance& placed) const {
        const Vec3f& center = placed.world_from_object.translation;
        const Lanes16 limit(scalar::kFarAway * placed.reach);
        const auto measure = [&](const Lanes16& from, float to) {
            const Lanes16 way = from - Lanes16(to);
            return max(way, Lanes16(to) - from);
        };
        return less(limit, max(max(measure(origin[0], center.x), measure(origin[1], center.y)),
                               measure(origin[2], center.z)));
    }

    /// relief::can_hit of each, repeated ones included.
    RELIEF_INLINE LaneMask can_hit() const {
        const Lanes16 all =
            (origin[0] + direction[0]) + (origin[1] + direction[1]) + (origin[2] + direction[2]);
        return equal(all - all, Lanes16(0.0f)) & less_equal(t_min, t_max);
    }
};

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
