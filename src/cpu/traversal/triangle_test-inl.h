// The exact test of triangles against rays, and which of several hits counts.
//
// Watertight after Woop, Benthin, Wald 2013 (Watertight Ray/Triangle Intersection): vertices are sheared into
// ray space once each, and an edge function of a shared edge is the same two rounded products subtracted in
// either order, so its sign is never wrong, only zero, and zero counts as inside. No fused operations here:
// they would break that.
#if defined(RELIEF_TRIANGLE_TEST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_TRIANGLE_TEST_INL_H
#undef RELIEF_TRIANGLE_TEST_INL_H
#else
#define RELIEF_TRIANGLE_TEST_INL_H
#endif

#include "cpu/traversal/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

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
HWY_INLINE void test_distances(const Lanes<W> (&z)[3], const Lanes<W>& rcp_dz_dt, const Lanes<W>& t_min,
                               const Lanes<W>& t_max, TriangleTest<W>& test) {
    const Lanes<W> sum = test.u + test.v + test.w;
    test.t = (test.u * z[0] + test.v * z[1] + test.w * z[2]) / sum * rcp_dz_dt;
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
    hit.instance = instance, hit.lod_bias = best.lod_bias;
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
