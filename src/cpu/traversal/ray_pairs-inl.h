// Pairs of a bundle's rays and micro-quads or polygons that they may meet, tested sixteen at once. One lane a
// triangle would leave most idle: few rays see a pixel-sized micro-quad, all see a large polygon.
#pragma once

#include <cstring>

#include "base/check.h"
#include "cpu/traversal/block_lanes-inl.h"
#include "cpu/traversal/frustum-inl.h"
#include "cpu/traversal/parallel_beam-inl.h"
#include "cpu/traversal/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Least and greatest value over the corners of each quad.
RELIEF_INLINE void find_quad_range(const Lanes16& vertex, Lanes8& least, Lanes8& greatest) {
    Lanes16 a, b, c;
    gather_corners(vertex, a, b, c);
    alignas(64) float low[16], high[16];
    min(min(a, b), c).store(low), max(max(a, b), c).store(high);
    least = min(Lanes8::load(low), Lanes8::load(low + 8));
    greatest = max(Lanes8::load(high), Lanes8::load(high + 8));
}

/// ProjectedLanes of the quads of a block; `v` is relative to the bundle's origin.
template <class Bundle>
RELIEF_INLINE PartBounds find_quad_bounds(const Lanes16 (&v)[3], const Bundle& bundle) {
    const Projected<16> seen = project(v, bundle);
    PartBounds quad;
    find_quad_range(seen.x, quad.lower_x, quad.upper_x);
    find_quad_range(seen.y, quad.lower_y, quad.upper_y);
    find_quad_range(seen.depth, quad.depth, quad.far);
    widen_bounds(bundle, quad);
    return quad;
}

/// ProjectedLanes of eight triangles; `v` (corner, axis) is relative to the bundle's origin.
template <class Bundle>
RELIEF_INLINE PartBounds find_triangle_bounds(const Lanes8 (&v)[3][3], const Bundle& bundle) {
    const Projected<8> a = project(v[0], bundle), b = project(v[1], bundle), c = project(v[2], bundle);
    PartBounds part = {min(min(a.x, b.x), c.x),
                       max(max(a.x, b.x), c.x),
                       min(min(a.y, b.y), c.y),
                       max(max(a.y, b.y), c.y),
                       min(min(a.depth, b.depth), c.depth),
                       max(max(a.depth, b.depth), c.depth)};
    widen_bounds(bundle, part);
    return part;
}

/// Of points; `v` is relative to the bundle's origin.
template <size_t W, class Bundle>
RELIEF_INLINE ProjectedBounds find_bounds(const Lanes<W> (&v)[3], const Bundle& bundle) {
    const Projected<W> seen = project(v, bundle);
    ProjectedBounds bounds = {reduce_min(seen.x), reduce_max(seen.x),     reduce_min(seen.y),
                              reduce_max(seen.y), reduce_min(seen.depth), reduce_max(seen.depth)};
    widen_bounds(bundle, bounds);
    return bounds;
}

/// Up to all pairs of a group of rays and eight parts, and what a step left over. With each pair goes what
/// its test reads of the ray: lanes that look it up elsewhere are slow.
template <int kValues> struct PairList {
    static constexpr uint32_t kCapacity = 8 * kGroupSize + 16;
    alignas(64) uint32_t code[kCapacity + 16]; ///< ray * 8 + part; a little more, for whole registers
    alignas(64) float value[kValues][kCapacity + 16];
    uint32_t count = 0;

    /// A step with fewer pairs than lanes loads what lies behind; its mask leaves that out.
    PairList() {
        std::memset(code, 0, 16 * sizeof(uint32_t));
        for (float* v : value) std::memset(v, 0, 16 * sizeof(float));
    }

    /// The rays of `mask` of a group with one part.
    RELIEF_INLINE void append_rays(LaneMask mask, uint32_t first_ray, uint32_t part,
                                   const Lanes16 (&values)[kValues]) {
        alignas(64) static constexpr uint32_t kRays[16] = {0,  8,  16, 24, 32, 40,  48,  56,
                                                           64, 72, 80, 88, 96, 104, 112, 120};
        constexpr size_t kLanes = Lanes16::kLanes;
        const Lanes16::D d;
        const hn::RebindToUnsigned<Lanes16::D> du;
        for (size_t p = 0; p < Lanes16::kParts; ++p) {
            const LaneMask of_part = mask >> (p * kLanes) & ((1u << kLanes) - 1);
            const auto codes = hn::Add(hn::Set(du, first_ray * 8 + part), hn::Load(du, kRays + p * kLanes));
            store_compressed(du, codes, of_part, code + count);
            for (int k = 0; k < kValues; ++k)
                store_compressed(d, values[k].part[p], of_part, value[k] + count);
            count += uint32_t(__builtin_popcount(of_part));
        }
        DCHECK(count <= kCapacity);
    }

    /// One ray with the parts of `mask`.
    template <class Bundle>
    RELIEF_INLINE void append_parts(LaneMask mask, uint32_t ray, const Bundle& bundle) {
        alignas(32) static constexpr uint32_t kParts[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        for (int k = 0; k < kValues; ++k) Lanes8(bundle.pair_value(k, ray)).store_unaligned(value[k] + count);
        constexpr size_t kLanes = Lanes8::kLanes;
        const hn::RebindToUnsigned<Lanes8::D> du;
        for (size_t p = 0; p < Lanes8::kParts; ++p) {
            const LaneMask of_part = mask >> (p * kLanes) & ((1u << kLanes) - 1);
            store_compressed(du, hn::Add(hn::Set(du, ray * 8), hn::Load(du, kParts + p * kLanes)), of_part,
                             code + count);
            count += uint32_t(__builtin_popcount(of_part));
        }
    }
};

template <class Bundle> using PairsOf = PairList<Bundle::kPairValues>;

/// Appends the pairs of the rays `left` of a group: ray by ray where they are fewer than the parts that
/// concern them, else quad by part. Returns the rays that have one.
template <class Bundle, class GroupLanes>
RELIEF_INLINE LaneMask append_pairs(const PartBounds& part, const Bundle& bundle, uint32_t group,
                                    const GroupLanes& rays, LaneMask left, PairsOf<Bundle>& pairs) {
    LaneMask parts = find_parts_of_group(part, bundle, group), paired = 0;
    const uint32_t at = group * kGroupSize;
    if (__builtin_popcount(left) <= __builtin_popcount(parts)) {
        for (; left; left &= left - 1) {
            const uint32_t lane = uint32_t(__builtin_ctz(left)), ray = at + lane;
            const LaneMask inside = find_parts_of_ray(part, bundle, ray);
            pairs.append_parts(inside, ray, bundle);
            paired |= LaneMask(inside != 0) << lane;
        }
        return paired;
    }
    alignas(32) float bound[6][8];
    part.lower_x.store(bound[0]), part.upper_x.store(bound[1]), part.lower_y.store(bound[2]);
    part.upper_y.store(bound[3]), part.depth.store(bound[4]), part.far.store(bound[5]);
    for (; parts; parts &= parts - 1) {
        const uint32_t q = uint32_t(__builtin_ctz(parts));
        const LaneMask inside = left & rays.find_inside({bound[0][q], bound[1][q], bound[2][q], bound[3][q],
                                                         bound[4][q], bound[5][q]});
        pairs.append_rays(inside, at, q, rays.pair_value);
        paired |= inside;
    }
    return paired;
}

/// Calls trace_pairs(list) for the pairs of rays with eight parts; marks the rays that were tested.
template <class Bundle, class TracePairs>
RELIEF_INLINE void visit_pairs(const PartBounds& part, const ProjectedBounds& all, const Bundle& bundle,
                               LaneMask (&tested)[kGroupCount], uint64_t& count, TracePairs trace_pairs) {
    PairsOf<Bundle> pairs;
    for (LaneMask groups = find_groups(all, bundle); groups; groups &= groups - 1) {
        const uint32_t group = uint32_t(__builtin_ctz(groups));
        const auto rays = load_lanes(bundle, group);
        const LaneMask left = rays.find_inside(all) & bundle.rays->group_mask(group);
        if (!left) continue;
        const LaneMask paired = append_pairs(part, bundle, group, rays, left, pairs);
        tested[group] |= paired;
        count += uint32_t(__builtin_popcount(paired));
        while (pairs.count >= 16) trace_pairs(pairs);
    }
    if (pairs.count > 0) trace_pairs(pairs);
}

/// Sixteen rays and the parts that they may meet.
template <int kValues> struct PairLanes {
    LaneIndices ray, part;
    Lanes16 value[kValues];
    LaneMask valid;

    /// Takes up to sixteen pairs from the end of the list.
    RELIEF_INLINE explicit PairLanes(PairList<kValues>& list) {
        const uint32_t count = HWY_MIN(list.count, 16u);
        list.count -= count;
        valid = (1u << count) - 1;
        const LaneIndices code = LaneIndices::load(list.code + list.count);
        ray = code.shifted_down<3>(), part = code.masked(7);
        for (int k = 0; k < kValues; ++k) value[k] = Lanes16::load_unaligned(list.value[k] + list.count);
    }
};

/// Corners of sixteen triangles or quads, relative to the rays: x and y as the ray of the lane sees them, z
/// along its major axis. `pick(corner, axis)` gives them relative to bundle.vertex_origin().
template <int kCount, class Bundle, class Pick>
RELIEF_INLINE void shear_corners(const PairLanes<Bundle::kPairValues>& pairs, const Bundle& bundle, Pick pick,
                                 Lanes16 (&corner)[3][kCount]) {
    for (int c = 0; c < kCount; ++c) {
        Lanes16 v[3];
        for (int k = 0; k < 3; ++k) v[k] = pick(c, bundle.axis[k]);
        shear_corner(pairs.value, v);
        for (int k = 0; k < 3; ++k) corner[k][c] = v[k];
    }
}

/// The triangles of corners 0, kSecond and kThird, however far along the rays: test.t is the place along the
/// major axis. False where no ray's line meets one.
template <int kSecond, int kThird, int kValues, int kCount>
RELIEF_INLINE bool test_pairs(const PairLanes<kValues>& pairs, const Lanes16 (&corner)[3][kCount],
                              TriangleTest<16>& test) {
    const auto pick = [&](int k, Lanes16(&of)[3]) __attribute__((always_inline)) {
        of[0] = corner[k][0], of[1] = corner[k][kSecond], of[2] = corner[k][kThird];
    };
    Lanes16 x[3], y[3], z[3];
    pick(0, x), pick(1, y), pick(2, z);
    test_edges(x, y, test);
    if (!(test.mask &= pairs.valid)) return false;
    return find_places(x, y, z, test) != 0;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
