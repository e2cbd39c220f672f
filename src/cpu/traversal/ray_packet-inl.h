// Sixteen rays of about one direction in an object's space: in lanes for boxes, singly for triangle blocks.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>

#include "cpu/traversal/ray-inl.h"
#include "cpu/traversal/ray_lanes-inl.h"
#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Bounds of all rays of a packet: nodes that they exclude are entered by none, since they go through the
/// same rounded operations as test_child (after Boulos, Wald, Shirley 2006, Geometric and Arithmetic
/// Culling). The rays are finite; empty slots, from +inf to -inf, are excluded.
struct PacketBounds {
    int near_plane[3], far_plane[3]; ///< rows of a node's bounds
    float near_origin[3], far_origin[3];
    float least_reciprocal[3], greatest_reciprocal[3];
    float t_min, t_max;
};

struct Packet {
    const cpu::TraceRay* world;
    const RayLanes* lanes; ///< of `world`
    RayState ray[16];      ///< in the space of the current object; hits and t_max live here
    Lanes16 lower_origin[3], upper_origin[3], reciprocal[3], t_min;
    alignas(64) float t_max[16];
    LaneMask active; ///< Query::any: lanes without a hit so far
    PacketBounds bounds;

    void find_bounds() {
        for (int k = 0; k < 3; ++k) {
            bounds.least_reciprocal[k] = reduce_min(reciprocal[k]);
            bounds.greatest_reciprocal[k] = reduce_max(reciprocal[k]);
            const float lower = reduce_max(lower_origin[k]), upper = reduce_min(upper_origin[k]);
            const bool is_negative = bounds.greatest_reciprocal[k] < 0;
            bounds.near_plane[k] = is_negative ? 3 + k : k, bounds.far_plane[k] = is_negative ? k : 3 + k;
            bounds.near_origin[k] = is_negative ? upper : lower;
            bounds.far_origin[k] = is_negative ? lower : upper;
            if (is_negative || bounds.least_reciprocal[k] > 0) continue;
            // Both ways along this axis: it excludes nothing.
            constexpr float kFar = std::numeric_limits<float>::max();
            bounds.least_reciprocal[k] = bounds.greatest_reciprocal[k] = 1;
            bounds.near_origin[k] = kFar, bounds.far_origin[k] = -kFar;
        }
        bounds.t_min = reduce_min(t_min);
        update_reach();
    }
    /// After t_max has become less.
    RELIEF_INLINE void update_reach() { bounds.t_max = reduce_max(Lanes16::load(t_max)); }
};

/// Whole numbers, to be stored where a RayState has integers.
RELIEF_INLINE Lanes16 integer_lanes(uint32_t number) { return Lanes16(std::bit_cast<float>(number)); }

/// Writes four numbers of each ray's state, the first of which is number `first` of it.
RELIEF_INLINE void store_quads(const Lanes16& a, const Lanes16& b, const Lanes16& c, const Lanes16& d,
                               size_t first, RayState (&rays)[16]) {
    LaneQuads quads;
    quads.set(a, b, c, d);
    for (size_t lane = 0; lane < 16; ++lane)
        std::memcpy(reinterpret_cast<char*>(&rays[lane]) + 4 * first, quads.lane[lane], 16);
}

/// What box tests ask of sixteen rays, for one axis.
struct AxisLanes {
    Lanes16 origin, direction, reciprocal, lower_origin, upper_origin;
    wide::Bool is_negative;

    Lanes16 near_origin() const { return wide::select(is_negative, upper_origin, lower_origin); }
    Lanes16 far_origin() const { return wide::select(is_negative, lower_origin, upper_origin); }
    Lanes16 near_plane(uint32_t k) const {
        return wide::select(is_negative, integer_lanes(3 + k), integer_lanes(k));
    }
    Lanes16 far_plane(uint32_t k) const {
        return wide::select(is_negative, integer_lanes(k), integer_lanes(3 + k));
    }
};

RELIEF_INLINE AxisLanes make_axis_lanes(const Lanes16& origin, const Lanes16& direction) {
    using wide::operator<;
    AxisLanes axis;
    axis.origin = origin, axis.direction = direction;
    const Lanes16 zero(0.0f), least(kLeastSpeed);
    const wide::Bool is_still = wide::abs(direction) < least;
    const Lanes16 margin =
        wide::select(is_still, Lanes16(1e-6f) * (wide::abs(origin) + Lanes16(1e-24f)), zero);
    axis.reciprocal = Lanes16(1.0f) / wide::select(is_still, least, direction);
    axis.lower_origin = origin + margin, axis.upper_origin = origin - margin;
    axis.is_negative = axis.reciprocal < zero;
    return axis;
}

/// The major axis of sixteen rays, and values of the axes chosen by it.
struct MajorAxis {
    wide::Bool is_x_over_y, is_not_z;

    RELIEF_INLINE explicit MajorAxis(const AxisLanes (&axis)[3]) {
        using wide::operator>;
        const Lanes16 x = wide::abs(axis[0].direction), y = wide::abs(axis[1].direction);
        is_x_over_y = x > y;
        is_not_z = wide::select(is_x_over_y, x, y) > wide::abs(axis[2].direction);
    }
    RELIEF_INLINE Lanes16 pick(const Lanes16& if_x, const Lanes16& if_y, const Lanes16& if_z) const {
        return wide::select(is_not_z, wide::select(is_x_over_y, if_x, if_y), if_z);
    }
};

// The order in which enter_object writes them, four at a time; hits follow.
static_assert(offsetof(RayState, reciprocal) == 4 * 3 && offsetof(RayState, near_origin) == 4 * 6 &&
              offsetof(RayState, far_origin) == 4 * 9 && offsetof(RayState, near_plane) == 4 * 12 &&
              offsetof(RayState, far_plane) == 4 * 15 && offsetof(RayState, axis) == 4 * 18 &&
              offsetof(RayState, shear) == 4 * 21 && offsetof(RayState, t_min) == 4 * 24 &&
              offsetof(RayState, t_max) == 4 * 25 && offsetof(RayState, instance) == 4 * 26 &&
              offsetof(RayState, shift) == 4 * 27 && offsetof(RayState, hit) == 4 * 28);

/// Sixteen rays into the space of an object: enter_object of each that is not far away, operation for
/// operation. `t_max` is how far they still ask; `instance` is kNoIndex for the world itself; hits stay as
/// they are.
RELIEF_INLINE void enter_object(const RayLanes& world, const Lanes16& t_max, const ObjectSpace& space,
                                uint32_t instance, Packet& packet) {
    const Affine& from_origin = space.from_origin;
    const float translation[3] = {from_origin.translation.x, from_origin.translation.y,
                                  from_origin.translation.z};
    const Lanes16 origin[3] = {world.origin[0] - Lanes16(space.origin.x),
                               world.origin[1] - Lanes16(space.origin.y),
                               world.origin[2] - Lanes16(space.origin.z)};
    AxisLanes axis[3];
    for (size_t k = 0; k < 3; ++k) {
        const Vec3f& row = from_origin.rows[k];
        axis[k] = make_axis_lanes(dot_lanes(origin, row) + Lanes16(translation[k]),
                                  dot_lanes(world.direction, row));
        packet.lower_origin[k] = axis[k].lower_origin, packet.upper_origin[k] = axis[k].upper_origin;
        packet.reciprocal[k] = axis[k].reciprocal;
    }
    packet.t_min = world.t_min, t_max.store(packet.t_max);
    packet.find_bounds();
    const AxisLanes &x = axis[0], &y = axis[1], &z = axis[2];
    RayState(&rays)[16] = packet.ray;
    store_quads(x.origin, y.origin, z.origin, x.reciprocal, 0, rays);
    store_quads(y.reciprocal, z.reciprocal, x.near_origin(), y.near_origin(), 4, rays);
    store_quads(z.near_origin(), x.far_origin(), y.far_origin(), z.far_origin(), 8, rays);
    store_quads(x.near_plane(0), y.near_plane(1), z.near_plane(2), x.far_plane(0), 12, rays);
    const MajorAxis major(axis);
    const Lanes16 number[3] = {integer_lanes(0), integer_lanes(1), integer_lanes(2)};
    store_quads(y.far_plane(1), z.far_plane(2), major.pick(number[1], number[2], number[0]),
                major.pick(number[2], number[0], number[1]), 16, rays);
    const Lanes16 inverse = Lanes16(1.0f) / major.pick(x.direction, y.direction, z.direction);
    store_quads(major.pick(number[0], number[1], number[2]),
                major.pick(y.direction, z.direction, x.direction) * inverse,
                major.pick(z.direction, x.direction, y.direction) * inverse, inverse, 20, rays);
    store_quads(world.t_min, t_max, integer_lanes(instance), Lanes16(0.0f), 24, rays);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
