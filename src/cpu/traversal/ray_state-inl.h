// One ray in the space of one object, and its exact test against a block of sixteen triangles.
//
// Watertight after Woop, Benthin, Wald 2013 (Watertight Ray/Triangle Intersection): vertices are sheared into
// ray space once each, and an edge function of a shared edge is the same two rounded products subtracted in
// either order, so its sign is never wrong, only zero, and zero counts as inside. No fused operations here:
// they would break that.
#if defined(RELIEF_RAY_STATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RAY_STATE_INL_H
#undef RELIEF_RAY_STATE_INL_H
#else
#define RELIEF_RAY_STATE_INL_H
#endif

#include <cmath>
#include <cstring>

#include "cpu/traversal/kernels.h"
#include "formulas/lanes-inl.h"
#include "formulas/object_ray.h"
#include "math/affine.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

enum class Query { closest, any };

using scalar::kBoxSlack;
using scalar::kLeastSpeed;

struct RayState {
    float origin[3], direction[3], reciprocal[3];
    float lower_origin[3], upper_origin[3]; ///< that lower and upper planes of boxes are measured from
    float near_origin[3], far_origin[3];    ///< the same, in the order in which the ray meets the planes
    int near_plane[3], far_plane[3]; ///< rows of a node's bounds that the ray meets first and last: k, 3 + k
    int axis[3];                     ///< two minor axes and the major one
    float shear[3];                  ///< of the minor axes; 1 / direction along the major one
    float t_min, t_max;
    uint32_t instance = kNoIndex;
    cpu::TraceHit hit;
};

/// Prepares a ray for an object; t keeps its meaning because the direction is not normalised.
HWY_INLINE void enter_object(const cpu::TraceRay& world, const Affine& object_from_world, RayState& ray) {
    const Vec3f o = transform_point(object_from_world, world.origin);
    const Vec3f d = transform_vector(object_from_world, world.direction);
    ray.origin[0] = o.x, ray.origin[1] = o.y, ray.origin[2] = o.z;
    ray.direction[0] = d.x, ray.direction[1] = d.y, ray.direction[2] = d.z;
    for (int k = 0; k < 3; ++k) {
        // Along an axis that the ray does not move on, 1 / 0 would make 0 * infinity on a box's very face. A
        // finite factor, and an origin moved outward by more than rounding, let such a ray touch the box and
        // miss its neighbours.
        const bool is_still = std::fabs(ray.direction[k]) < kLeastSpeed;
        const float margin = is_still ? 1e-6f * (std::fabs(ray.origin[k]) + 1e-24f) : 0.0f;
        ray.reciprocal[k] = 1.0f / (is_still ? kLeastSpeed : ray.direction[k]);
        ray.lower_origin[k] = ray.origin[k] + margin;
        ray.upper_origin[k] = ray.origin[k] - margin;
        const bool is_negative = ray.reciprocal[k] < 0;
        ray.near_plane[k] = is_negative ? 3 + k : k;
        ray.far_plane[k] = is_negative ? k : 3 + k;
        ray.near_origin[k] = is_negative ? ray.upper_origin[k] : ray.lower_origin[k];
        ray.far_origin[k] = is_negative ? ray.lower_origin[k] : ray.upper_origin[k];
    }
    const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
    // Choices of values and a table: no processor foresees which axis it will be.
    static constexpr int kMinorAxes[3][2] = {{1, 2}, {2, 0}, {0, 1}};
    const int wider = ax > ay ? 0 : 1;
    const int major = (ax > ay ? ax : ay) > az ? wider : 2;
    ray.axis[2] = major, ray.axis[0] = kMinorAxes[major][0], ray.axis[1] = kMinorAxes[major][1];
    ray.shear[2] = 1.0f / ray.direction[major];
    ray.shear[0] = ray.direction[ray.axis[0]] * ray.shear[2];
    ray.shear[1] = ray.direction[ray.axis[1]] * ray.shear[2];
}

/// Entry distances of W boxes (lower x y z, upper x y z) and the mask of those met in [t_min, t_max].
template <size_t W>
HWY_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const RayState& ray, Lanes<W>& entry) {
    Lanes<W> near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes<W> reciprocal(ray.reciprocal[k]);
        const Lanes<W> lower = (bound[k] - Lanes<W>(ray.lower_origin[k])) * reciprocal;
        const Lanes<W> upper = (bound[3 + k] - Lanes<W>(ray.upper_origin[k])) * reciprocal;
        const bool is_negative = ray.reciprocal[k] < 0;
        near[k] = is_negative ? upper : lower;
        far[k] = is_negative ? lower : upper;
    }
    entry = max(max(near[0], near[1]), max(near[2], Lanes<W>(ray.t_min)));
    const Lanes<W> exit = min(min(far[0], far[1]), min(far[2], Lanes<W>(ray.t_max)));
    return less_equal(entry, exit * Lanes<W>(kBoxSlack));
}

/// The same for the boxes of a node, lower x y z, upper x y z: which plane is near is known before it is
/// loaded.
template <size_t W>
HWY_INLINE LaneMask test_node(const float (&bounds)[6][W], const RayState& ray, Lanes<W>& entry) {
    Lanes<W> near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes<W> reciprocal(ray.reciprocal[k]);
        near[k] = (Lanes<W>::load(bounds[ray.near_plane[k]]) - Lanes<W>(ray.near_origin[k])) * reciprocal;
        far[k] = (Lanes<W>::load(bounds[ray.far_plane[k]]) - Lanes<W>(ray.far_origin[k])) * reciprocal;
    }
    entry = max(max(near[0], near[1]), max(near[2], Lanes<W>(ray.t_min)));
    const Lanes<W> exit = min(min(far[0], far[1]), min(far[2], Lanes<W>(ray.t_max)));
    return less_equal(entry, exit * Lanes<W>(kBoxSlack));
}

/// The same for the children of a quantised node, by the decoder that the builder checked with.
HWY_INLINE LaneMask test_node(const WideNode& node, const RayState& ray, Lanes8& entry) {
    Lanes8 near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const float scale = WideNode::decode_scale(node.exponent[k]);
        const Lanes8 near_bound = Lanes8::decode(node.planes[ray.near_plane[k]], node.origin[k], scale);
        const Lanes8 far_bound = Lanes8::decode(node.planes[ray.far_plane[k]], node.origin[k], scale);
        const Lanes8 reciprocal(ray.reciprocal[k]);
        near[k] = (near_bound - Lanes8(ray.near_origin[k])) * reciprocal;
        far[k] = (far_bound - Lanes8(ray.far_origin[k])) * reciprocal;
    }
    entry = max(max(near[0], near[1]), max(near[2], Lanes8(ray.t_min)));
    const Lanes8 exit = min(min(far[0], far[1]), min(far[2], Lanes8(ray.t_max)));
    return less_equal(entry, exit * Lanes8(kBoxSlack)) & ((1u << node.child_count) - 1);
}

/// Entries of children that a ray is to visit: the entry distance with its last bits replaced by the child,
/// so that whole numbers in rising order are distances in rising order (from t >= 0; below, any order will
/// do). Up to kCapacity children, a power of two.
template <uint32_t kCapacity> struct EntryList {
    static constexpr uint32_t kChildMask = kCapacity - 1;
    alignas(64) uint32_t key[kCapacity + 16]; ///< a little more than fits: whole registers are stored
    uint32_t count = 0;

    /// Appends the lanes of `mask` as children first, first + 1...; `first` is a multiple of W.
    template <size_t W> HWY_INLINE void append(LaneMask mask, const Lanes<W>& entry, uint32_t first) {
        // Read from memory: compilers make a mess of a vector that counts up from a variable.
        alignas(64) static constexpr uint32_t kNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                              8, 9, 10, 11, 12, 13, 14, 15};
        const hn::RebindToUnsigned<typename Lanes<W>::D> d;
        constexpr size_t kLanes = Lanes<W>::kLanes;
        for (size_t p = 0; p < Lanes<W>::kParts; ++p) {
            const auto distance = hn::AndNot(hn::Set(d, kChildMask), hn::BitCast(d, entry.part[p]));
            const auto child = hn::Or(hn::Set(d, first), hn::Load(d, kNumbers + p * kLanes));
            const LaneMask part = mask >> (p * kLanes);
            store_compressed(d, hn::Or(distance, child), part, key + count);
            count += uint32_t(__builtin_popcount(part & ((1u << kLanes) - 1)));
        }
    }

    HWY_INLINE void sort() {
        for (uint32_t k = 1; k < count; ++k) {
            const uint32_t next = key[k];
            uint32_t slot = k;
            for (; slot > 0 && key[slot - 1] > next; --slot) key[slot] = key[slot - 1];
            key[slot] = next;
        }
    }

    uint32_t child(uint32_t k) const { return key[k] & kChildMask; }
    /// Not above the entry distance (from t >= 0).
    float distance(uint32_t k) const {
        const uint32_t bits = key[k] & ~kChildMask;
        float result;
        std::memcpy(&result, &bits, sizeof(result));
        return result;
    }
};

/// Calls visit(child) for the lanes of `mask`, nearest entry first, while they begin before ray.t_max; stops
/// on true.
template <size_t W, class Visit>
HWY_INLINE bool visit_in_order(LaneMask mask, const Lanes<W>& entry, const RayState& ray, Visit visit) {
    if ((mask & (mask - 1)) == 0) return mask != 0 && visit(uint32_t(__builtin_ctz(mask)));
    EntryList<16> entries;
    entries.append(mask, entry, 0);
    entries.sort();
    for (uint32_t k = 0; k < entries.count; ++k)
        if (entries.distance(k) <= ray.t_max * kBoxSlack && visit(entries.child(k))) return true;
    return false;
}

/// One coordinate of the fifteen vertices of a block, row by row: `first` is its first vertex in a grid with
/// `columns` vertices a row. Lane 15 is any number; reads up to one number past the last vertex.
HWY_INLINE Lanes16 load_block(const float* first, uint32_t columns) {
    constexpr size_t kRow = 5;
    const Lanes16::D d;
    // Where the lanes of each row would begin if they were the first of all.
    const float* const second = first + columns - kRow;
    const float* const third = second + columns - kRow;
    Lanes16 r;
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        const size_t begin = p * Lanes16::kLanes, end = begin + Lanes16::kLanes;
        auto v = hn::LoadU(d, (begin < kRow ? first : begin < 2 * kRow ? second : third) + begin);
        if (begin < kRow && kRow < end)
            v = hn::IfThenElse(hn::FirstN(d, kRow - begin), v, hn::LoadU(d, second + begin));
        if (begin < 2 * kRow && 2 * kRow < end)
            v = hn::IfThenElse(hn::FirstN(d, 2 * kRow - begin), v, hn::LoadU(d, third + begin));
        r.part[p] = v;
    }
    return r;
}

/// The vertices of a block with lane 15 like lane 0.
HWY_INLINE Lanes16 hide_last(const Lanes16& vertex) {
    const Lanes16::D d;
    Lanes16 r = vertex;
    auto& last = r.part[Lanes16::kParts - 1];
    last = hn::IfThenElse(hn::FirstN(d, Lanes16::kLanes - 1), last, hn::Set(d, hn::GetLane(vertex.part[0])));
    return r;
}

/// One corner of the eight quads of a block out of two registers: the first kFromFirst come from the first
/// one.
template <size_t kFromFirst, size_t W>
HWY_INLINE auto pick_corner(const Lanes<W>& vertex, const int32_t (&number_in_register)[8]) {
    const Lanes8::D d;
    const auto index = hn::SetTableIndices(d, number_in_register);
    return hn::IfThenElse(hn::FirstN(d, kFromFirst), hn::TableLookupLanes(vertex.part[0], index),
                          hn::TableLookupLanes(vertex.part[1], index));
}

/// The three corners of sixteen triangles of a block, one coordinate: lanes 0..7 are (00, 10, 11), 8..15 (00,
/// 11, 01) of cells 0..3 of the first row, then of the second.
template <size_t W>
HWY_INLINE void gather_corners(const Lanes<W>& vertex, Lanes<W>& a, Lanes<W>& b, Lanes<W>& c) {
    static_assert(W == 16);
    if constexpr (Lanes<W>::kParts == 1) {
        alignas(64) static constexpr int32_t kA[16] = {0, 1, 2, 3, 5, 6, 7, 8, 0, 1, 2, 3, 5, 6, 7, 8};
        alignas(64) static constexpr int32_t kB[16] = {1, 2, 3, 4, 6, 7, 8, 9, 6, 7, 8, 9, 11, 12, 13, 14};
        alignas(64) static constexpr int32_t kC[16] = {6, 7, 8, 9, 11, 12, 13, 14,
                                                       5, 6, 7, 8, 10, 11, 12, 13};
        const Lanes16::D d;
        a.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kA));
        b.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kB));
        c.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kC));
    } else if constexpr (Lanes<W>::kParts == 2) {
        // Not through memory: loads across two stores have to wait for them.
        alignas(32) static constexpr int32_t k00[8] = {0, 1, 2, 3, 5, 6, 7, 0},
                                             k10[8] = {1, 2, 3, 4, 6, 7, 0, 1},
                                             k11[8] = {6, 7, 0, 1, 3, 4, 5, 6},
                                             k01[8] = {5, 6, 7, 0, 2, 3, 4, 5};
        a.part[0] = a.part[1] = pick_corner<7>(vertex, k00);
        b.part[0] = pick_corner<6>(vertex, k10);
        c.part[0] = b.part[1] = pick_corner<2>(vertex, k11);
        c.part[1] = pick_corner<3>(vertex, k01);
    } else {
        alignas(64) float v[16], p00[8], p10[8], p11[8], p01[8];
        vertex.store(v);
        for (int row = 0; row < 2; ++row) {
            Lanes4::load_unaligned(v + 5 * row).store(p00 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 1).store(p10 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 6).store(p11 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 5).store(p01 + 4 * row);
        }
        constexpr size_t kHalf = 8 / Lanes16::kLanes;
        for (size_t p = 0; p < kHalf; ++p) {
            const Lanes16::D d;
            const size_t at = p * Lanes16::kLanes;
            a.part[p] = a.part[kHalf + p] = hn::Load(d, p00 + at);
            b.part[p] = hn::Load(d, p10 + at);
            c.part[p] = b.part[kHalf + p] = hn::Load(d, p11 + at);
            c.part[kHalf + p] = hn::Load(d, p01 + at);
        }
    }
}

/// W triangles in ray space: edge functions opposite a, b, c and the distances of the hits among `mask`.
template <size_t W> struct TriangleTest {
    Lanes<W> u, v, w, t;
    LaneMask mask;
};

template <size_t W>
HWY_INLINE LaneMask test_edges(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3], TriangleTest<W>& test) {
    test.u = x[2] * y[1] - y[2] * x[1];
    test.v = x[0] * y[2] - y[0] * x[2];
    test.w = x[1] * y[0] - y[1] * x[0];
    return test.mask = same_side(test.u, test.v, test.w);
}

template <size_t W>
HWY_INLINE void test_distances(const Lanes<W> (&z)[3], const Lanes<W>& inverse_speed, const Lanes<W>& t_min,
                               const Lanes<W>& t_max, TriangleTest<W>& test) {
    const Lanes<W> sum = test.u + test.v + test.w;
    test.t = (test.u * z[0] + test.v * z[1] + test.w * z[2]) / sum * inverse_speed;
    test.mask &= not_equal(sum, Lanes<W>(0.0f)) & less(t_min, test.t) & less_equal(test.t, t_max);
}

template <size_t W>
HWY_INLINE void test_distances(const Lanes<W> (&z)[3], const RayState& ray, TriangleTest<W>& test) {
    test_distances(z, Lanes<W>(ray.shear[2]), Lanes<W>(ray.t_min), Lanes<W>(ray.t_max), test);
}

/// Vertices relative to the ray: sheared x and y, and z along the major axis. load(axis) gives coordinates.
template <size_t W, class Load>
HWY_INLINE void shear_vertices(Load load, const RayState& ray, Lanes<W>& x, Lanes<W>& y, Lanes<W>& z) {
    z = load(ray.axis[2]) - Lanes<W>(ray.origin[ray.axis[2]]);
    x = (load(ray.axis[0]) - Lanes<W>(ray.origin[ray.axis[0]])) - Lanes<W>(ray.shear[0]) * z;
    y = (load(ray.axis[1]) - Lanes<W>(ray.origin[ray.axis[1]])) - Lanes<W>(ray.shear[1]) * z;
}

/// The order of hits that are as near as each other: (instance, patch, j, i, upper). The result then does not
/// depend on the order in which triangles were met.
HWY_INLINE bool comes_before(const cpu::TraceHit& a, const cpu::TraceHit& b) {
    const auto rank = [](const cpu::TraceHit& h) {
        return uint64_t(h.j) << 17 | uint64_t(h.i) << 1 | h.is_upper;
    };
    return a.instance != b.instance ? a.instance < b.instance
           : a.patch != b.patch     ? a.patch < b.patch
                                    : rank(a) < rank(b);
}

/// Takes over a hit if it is nearer, or as near and first in that order. `reach` becomes its distance.
HWY_INLINE void offer_hit(cpu::TraceHit& best, float& reach, const cpu::TraceHit& hit) {
    if (hit.t == best.t ? !comes_before(hit, best) : !(hit.t < best.t)) return;
    best = hit;
    reach = hit.t;
}

/// The numbers of a triangle test, lane by lane.
template <size_t W> struct TriangleHits {
    alignas(64) float u[W], v[W], w[W], t[W];

    HWY_INLINE explicit TriangleHits(const TriangleTest<W>& test) {
        test.u.store(u), test.v.store(v), test.w.store(w), test.t.store(t);
    }
};

/// Offers the hit of one lane; locate(lane, weight_b, weight_c, hit) fills in cell, is_upper and, from the
/// weights of the three corners, u and v.
template <size_t W, class Locate>
HWY_INLINE void offer_hit(cpu::TraceHit& best, float& reach, uint32_t instance, const TriangleHits<W>& hits,
                          uint32_t lane, Locate locate) {
    if (hits.t[lane] > reach) return;
    const float sum = hits.u[lane] + hits.v[lane] + hits.w[lane];
    cpu::TraceHit hit;
    hit.t = hits.t[lane];
    hit.instance = instance, hit.bias = best.bias;
    locate(lane, hits.v[lane] / sum, hits.w[lane] / sum, hit);
    offer_hit(best, reach, hit);
}

/// Offers every hit of a triangle test.
template <size_t W, class Locate>
HWY_INLINE void offer_hits(cpu::TraceHit& best, float& reach, uint32_t instance, const TriangleTest<W>& test,
                           Locate locate) {
    const TriangleHits<W> hits(test);
    for (LaneMask mask = test.mask; mask; mask &= mask - 1)
        offer_hit(best, reach, instance, hits, uint32_t(__builtin_ctz(mask)), locate);
}

template <size_t W, class Locate>
HWY_INLINE void offer_hits(RayState& ray, const TriangleTest<W>& test, Locate locate) {
    offer_hits(ray.hit, ray.t_max, ray.instance, test, locate);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
