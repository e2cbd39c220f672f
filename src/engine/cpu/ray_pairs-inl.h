// Which rays of a bundle may meet which micro-quads of a block, or triangles of a polygon: pairs of the two,
// sixteen of them tested at once. Where a micro-quad is about as large as a pixel, few rays see it, and where
// a polygon is large, all do: a lane a triangle of one block would leave most lanes idle.
#if defined(RELIEF_RAY_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RAY_PAIRS_INL_H
#undef RELIEF_RAY_PAIRS_INL_H
#else
#define RELIEF_RAY_PAIRS_INL_H
#endif

#include <cstring>

#include "base/check.h"
#include "engine/cpu/ray_bundle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Windows of the eight quads of a block, in the order of the lower triangles' lanes, or of eight triangles.
struct PartWindows {
    Lanes8 lower_x, upper_x, lower_y, upper_y, depth;
};

/// Makes room for rounding. All windows are open where a part is not in front of the rays, or far aside: what
/// is seen of it cannot be said. Parts that are not numbers are not there; a ray that is tested against one
/// nevertheless misses it.
HWY_INLINE void widen_windows(PartWindows& part) {
    const LaneMask is_there = less_equal(part.depth, part.depth);
    const LaneMask is_in_front = less(Lanes8(0.0f), part.depth) & less(Lanes8(-kWidestWindow), part.lower_x) &
                                 less(part.upper_x, Lanes8(kWidestWindow)) &
                                 less(Lanes8(-kWidestWindow), part.lower_y) &
                                 less(part.upper_y, Lanes8(kWidestWindow));
    if (is_there != is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        part = {Lanes8(-kEnd), Lanes8(kEnd), Lanes8(-kEnd), Lanes8(kEnd), Lanes8(-kEnd)};
        return;
    }
    const Lanes8 zero(0.0f);
    const Lanes8 aside = max(max(zero - part.lower_x, part.upper_x), max(zero - part.lower_y, part.upper_y));
    const Lanes8 margin = Lanes8(kWindowMargin) * max(Lanes8(1.0f), aside);
    part.lower_x = part.lower_x - margin, part.upper_x = part.upper_x + margin;
    part.lower_y = part.lower_y - margin, part.upper_y = part.upper_y + margin;
    part.depth = part.depth * (Lanes8(kDepthSlack) - margin);
}

/// Least and greatest value over the corners of each quad.
HWY_INLINE void find_quad_range(const Lanes16& vertex, Lanes8& least, Lanes8& greatest) {
    Lanes16 a, b, c;
    gather_corners(vertex, a, b, c);
    alignas(64) float low[16], high[16];
    min(min(a, b), c).store(low), max(max(a, b), c).store(high);
    least = min(Lanes8::load(low), Lanes8::load(low + 8));
    greatest = max(Lanes8::load(high), Lanes8::load(high + 8));
}

/// Windows of the quads of a block, and of all of them; `v` is relative to the origin of the rays.
HWY_INLINE PartWindows find_quad_windows(const Lanes16 (&v)[3], const RayBundle& bundle, Window& all) {
    const Lanes16 depth = dot_lanes(v, bundle.forward), inverse = Lanes16(1.0f) / depth;
    PartWindows quad;
    Lanes8 farthest;
    find_quad_range(dot_lanes(v, bundle.right) * inverse, quad.lower_x, quad.upper_x);
    find_quad_range(dot_lanes(v, bundle.up) * inverse, quad.lower_y, quad.upper_y);
    find_quad_range(depth, quad.depth, farthest);
    widen_windows(quad);
    all = {reduce_min(quad.lower_x), reduce_max(quad.upper_x), reduce_min(quad.lower_y),
           reduce_max(quad.upper_y), reduce_min(quad.depth)};
    return quad;
}

/// Windows of eight triangles; `v` (corner, axis) is relative to the origin of the rays.
HWY_INLINE PartWindows find_triangle_windows(const Lanes8 (&v)[3][3], const RayBundle& bundle) {
    Lanes8 x[3], y[3], depth[3];
    for (int c = 0; c < 3; ++c) {
        depth[c] = dot_lanes(v[c], bundle.forward);
        const Lanes8 inverse = Lanes8(1.0f) / depth[c];
        x[c] = dot_lanes(v[c], bundle.right) * inverse, y[c] = dot_lanes(v[c], bundle.up) * inverse;
    }
    PartWindows part = {min(min(x[0], x[1]), x[2]), max(max(x[0], x[1]), x[2]), min(min(y[0], y[1]), y[2]),
                        max(max(y[0], y[1]), y[2]), min(min(depth[0], depth[1]), depth[2])};
    widen_windows(part);
    return part;
}

/// Up to all pairs of a group of rays and eight parts, and what a step left over. With each pair goes what
/// its test reads of the ray: lanes that look it up elsewhere are slow.
struct PairList {
    static constexpr uint32_t kCapacity = 8 * kGroupSize + 16;
    alignas(64) uint32_t code[kCapacity + 16]; ///< ray * 8 + part; a little more, for whole registers
    alignas(64) float shear[2][kCapacity + 16];
    uint32_t count = 0;

    /// A step with fewer pairs than lanes loads what lies behind them: any numbers, which its mask leaves
    /// out.
    PairList() {
        std::memset(code, 0, 16 * sizeof(uint32_t));
        for (float* s : shear) std::memset(s, 0, 16 * sizeof(float));
    }

    /// The rays of `mask` of a group with one part.
    HWY_INLINE void append_rays(LaneMask mask, uint32_t first_ray, uint32_t part, const Lanes16& shear_x,
                                const Lanes16& shear_y) {
        alignas(64) static constexpr uint32_t kRays[16] = {0,  8,  16, 24, 32, 40,  48,  56,
                                                           64, 72, 80, 88, 96, 104, 112, 120};
        constexpr size_t kLanes = Lanes16::kLanes;
        const Lanes16::D d;
        const hn::RebindToUnsigned<Lanes16::D> du;
        for (size_t p = 0; p < Lanes16::kParts; ++p) {
            const LaneMask of_part = mask >> (p * kLanes) & ((1u << kLanes) - 1);
            const auto codes = hn::Add(hn::Set(du, first_ray * 8 + part), hn::Load(du, kRays + p * kLanes));
            store_compressed(du, codes, of_part, code + count);
            store_compressed(d, shear_x.part[p], of_part, shear[0] + count);
            store_compressed(d, shear_y.part[p], of_part, shear[1] + count);
            count += uint32_t(__builtin_popcount(of_part));
        }
        DCHECK(count <= kCapacity);
    }

    /// One ray with the parts of `mask`.
    HWY_INLINE void append_parts(LaneMask mask, uint32_t ray, float shear_x, float shear_y) {
        alignas(32) static constexpr uint32_t kParts[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        Lanes8(shear_x).store_unaligned(shear[0] + count);
        Lanes8(shear_y).store_unaligned(shear[1] + count);
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

/// The parts that any ray of a group may meet.
HWY_INLINE LaneMask find_parts(const PartWindows& part, const RayBundle& bundle, uint32_t group) {
    return less_equal(part.lower_x, Lanes8(bundle.upper_x[group])) &
           less_equal(Lanes8(bundle.lower_x[group]), part.upper_x) &
           less_equal(part.lower_y, Lanes8(bundle.upper_y[group])) &
           less_equal(Lanes8(bundle.lower_y[group]), part.upper_y) &
           less_equal(part.depth, Lanes8(bundle.group_farthest[group]));
}

/// Sixteen rays as the windows see them.
struct GroupLanes {
    Lanes16 x, y, depth; ///< depth of the nearest hit
    Lanes16 shear_x, shear_y;

    GroupLanes(const RayBundle& bundle, uint32_t group) {
        const size_t at = group * kGroupSize;
        x = Lanes16::load(bundle.x + at), y = Lanes16::load(bundle.y + at);
        depth = Lanes16::load(bundle.rays->t + at) * Lanes16::load(bundle.speed + at);
        shear_x = Lanes16::load(bundle.shear[0] + at), shear_y = Lanes16::load(bundle.shear[1] + at);
    }
    HWY_INLINE LaneMask find_inside(float lower_x, float upper_x, float lower_y, float upper_y,
                                    float nearest) const {
        return less_equal(Lanes16(lower_x), x) & less_equal(x, Lanes16(upper_x)) &
               less_equal(Lanes16(lower_y), y) & less_equal(y, Lanes16(upper_y)) &
               less_equal(Lanes16(nearest), depth);
    }
};

/// Appends the pairs of the rays `left` of a group: ray by ray where they are fewer than the parts that
/// concern them, else quad by part. Returns the rays that have one.
HWY_INLINE LaneMask append_pairs(const PartWindows& part, const RayBundle& bundle, uint32_t group,
                                 const GroupLanes& rays, LaneMask left, PairList& pairs) {
    LaneMask parts = find_parts(part, bundle, group), paired = 0;
    const uint32_t at = group * kGroupSize;
    if (__builtin_popcount(left) <= __builtin_popcount(parts)) {
        for (; left; left &= left - 1) {
            const uint32_t lane = uint32_t(__builtin_ctz(left)), ray = at + lane;
            const Lanes8 x(bundle.x[ray]), y(bundle.y[ray]);
            const LaneMask inside = less_equal(part.lower_x, x) & less_equal(x, part.upper_x) &
                                    less_equal(part.lower_y, y) & less_equal(y, part.upper_y) &
                                    less_equal(part.depth, Lanes8(bundle.rays->t[ray] * bundle.speed[ray]));
            pairs.append_parts(inside, ray, bundle.shear[0][ray], bundle.shear[1][ray]);
            paired |= LaneMask(inside != 0) << lane;
        }
        return paired;
    }
    alignas(32) float bound[5][8];
    part.lower_x.store(bound[0]), part.upper_x.store(bound[1]), part.lower_y.store(bound[2]);
    part.upper_y.store(bound[3]), part.depth.store(bound[4]);
    for (; parts; parts &= parts - 1) {
        const uint32_t q = uint32_t(__builtin_ctz(parts));
        const LaneMask inside =
            left & rays.find_inside(bound[0][q], bound[1][q], bound[2][q], bound[3][q], bound[4][q]);
        pairs.append_rays(inside, at, q, rays.shear_x, rays.shear_y);
        paired |= inside;
    }
    return paired;
}

/// Calls trace_pairs(list) for the pairs of a bundle's rays with eight parts, until none is left; `all` holds
/// all windows. Sets the bits of rays that were tested.
template <class TracePairs>
HWY_INLINE void visit_pairs(const PartWindows& part, const Window& all, const RayBundle& bundle,
                            LaneMask (&tested)[kGroupCount], uint64_t& count, TracePairs trace_pairs) {
    PairList pairs;
    for (LaneMask groups = find_groups(all, bundle); groups; groups &= groups - 1) {
        const uint32_t group = uint32_t(__builtin_ctz(groups));
        const GroupLanes rays(bundle, group);
        const LaneMask left =
            rays.find_inside(all.lower_x, all.upper_x, all.lower_y, all.upper_y, all.depth) &
            bundle.rays->group_mask(group);
        if (!left) continue;
        const LaneMask paired = append_pairs(part, bundle, group, rays, left, pairs);
        tested[group] |= paired;
        count += uint32_t(__builtin_popcount(paired));
        while (pairs.count >= 16) trace_pairs(pairs);
    }
    if (pairs.count > 0) trace_pairs(pairs);
}

/// Sixteen rays and the parts that they may meet.
struct PairLanes {
    LaneIndices ray, part;
    Lanes16 shear_x, shear_y;
    LaneMask valid;

    /// Takes up to sixteen pairs from the end of the list.
    HWY_INLINE explicit PairLanes(PairList& list) {
        const uint32_t count = HWY_MIN(list.count, 16u);
        list.count -= count;
        valid = (1u << count) - 1;
        const LaneIndices code = LaneIndices::load(list.code + list.count);
        ray = code.shifted_down<3>(), part = code.masked(7);
        shear_x = Lanes16::load_unaligned(list.shear[0] + list.count);
        shear_y = Lanes16::load_unaligned(list.shear[1] + list.count);
    }
};

/// Corners of sixteen triangles or quads, relative to the origin of the rays: x and y as the ray of the lane
/// sees them, z along its major axis. `pick(corner, axis)` gives what is in memory.
template <int kCount, class Pick>
HWY_INLINE void shear_corners(const PairLanes& pairs, const RayBundle& bundle, Pick pick,
                              Lanes16 (&corner)[3][kCount]) {
    for (int c = 0; c < kCount; ++c) {
        const Lanes16 z = pick(c, bundle.axis[2]);
        corner[0][c] = pick(c, bundle.axis[0]) - pairs.shear_x * z;
        corner[1][c] = pick(c, bundle.axis[1]) - pairs.shear_y * z;
        corner[2][c] = z;
    }
}

/// The triangles of corners 0, kSecond and kThird, however far along the rays: test.t is the place along the
/// major axis. False where no ray's line meets one.
template <int kSecond, int kThird, int kCount>
HWY_INLINE bool test_pairs(const PairLanes& pairs, const Lanes16 (&corner)[3][kCount],
                           TriangleTest<16>& test) {
    const auto pick = [&](int k, Lanes16(&of)[3]) __attribute__((always_inline)) {
        of[0] = corner[k][0], of[1] = corner[k][kSecond], of[2] = corner[k][kThird];
    };
    Lanes16 x[3], y[3], z[3];
    pick(0, x), pick(1, y), pick(2, z);
    test_edges(x, y, test);
    if (!(test.mask &= pairs.valid)) return false;
    const Lanes16 sum = test.u + test.v + test.w;
    test.t = (test.u * z[0] + test.v * z[1] + test.w * z[2]) / sum;
    return (test.mask &= not_equal(sum, Lanes16(0.0f))) != 0;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
