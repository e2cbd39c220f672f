// The exact test of triangles against rays, and which of several hits counts.
//
// Watertight after Woop, Benthin, Wald 2013: vertices are sheared into ray space once each, and an edge
// function is the same rounded products subtracted in either order: its sign is never wrong, only zero, which
// counts as inside. Fused operations would break that. Hits in doubt are decided by formulas/exact_edge.h.
#pragma once

#include "cpu/traversal/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// W triangles in ray space: edge functions opposite a, b, c and the distances of the hits among `mask`.
template <size_t W> struct TriangleTest {
    Lanes<W> u, v, w, t;
    LaneMask mask;
};

template <size_t W>
RELIEF_INLINE LaneMask test_edges(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3], TriangleTest<W>& test) {
    test.u = x[2] * y[1] - y[2] * x[1];
    test.v = x[0] * y[2] - y[0] * x[2];
    test.w = x[1] * y[0] - y[1] * x[0];
    return test.mask = same_side(test.u, test.v, test.w);
}

/// The triangles of `test.mask` for which scalar::is_place_doubtful is true.
template <size_t W>
RELIEF_INLINE LaneMask find_doubtful_places(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3],
                                            const Lanes<W> (&z)[3], const Lanes<W>& weighted_z,
                                            const TriangleTest<W>& test) {
    const LaneMask around_origin = test.mask & ~same_side(z[0], z[1], z[2]);
    if (!around_origin) [[likely]]
        return 0;
    const auto find_largest = [](const Lanes<W>(&of)[3]) {
        return max(max(magnitude(of[0]), magnitude(of[1])), magnitude(of[2]));
    };
    const Lanes<W> products = find_largest(x) * find_largest(y);
    const Lanes<W> rounding = products * find_largest(z) * Lanes<W>(scalar::kEdgeRounding);
    return around_origin & less_equal(magnitude(weighted_z), rounding);
}

/// Corners as rays see them and edge functions of W triangles, in memory.
template <size_t W> struct StoredEdges { alignas(64) float x[3][W], y[3][W], edge[3][W]; };

template <size_t W> HWY_NOINLINE void refine_stored_edges(LaneMask lanes, StoredEdges<W>& stored) {
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(lanes));
        for (int k = 0; k < 3; ++k) {
            const int from = (k + 2) % 3, to = (k + 1) % 3;
            stored.edge[k][lane] = scalar::find_exact_edge(stored.x[from][lane], stored.y[from][lane],
                                                           stored.x[to][lane], stored.y[to][lane]);
        }
    }
}

/// Replaces the edge functions of some lanes by scalar::find_exact_edge, and removes those from test.mask
/// that miss their triangles then. Corners are stored only here: the usual path keeps them in registers.
template <size_t W>
RELIEF_INLINE void refine_edges(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3], LaneMask lanes,
                                TriangleTest<W>& test) {
    StoredEdges<W> stored;
    for (int k = 0; k < 3; ++k) x[k].store(stored.x[k]), y[k].store(stored.y[k]);
    test.u.store(stored.edge[0]), test.v.store(stored.edge[1]), test.w.store(stored.edge[2]);
    refine_stored_edges(lanes, stored);
    test.u = Lanes<W>::load(stored.edge[0]), test.v = Lanes<W>::load(stored.edge[1]);
    test.w = Lanes<W>::load(stored.edge[2]);
    test.mask &= same_side(test.u, test.v, test.w) | ~lanes;
}

/// Sets test.t to the places of the hits along the major axis, and removes triangles without area from
/// test.mask.
template <size_t W>
RELIEF_INLINE LaneMask find_places(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3], const Lanes<W> (&z)[3],
                                   TriangleTest<W>& test) {
    const auto weigh_z = [&] { return test.u * z[0] + test.v * z[1] + test.w * z[2]; };
    const auto add_edges = [&] { return test.u + test.v + test.w; };
    Lanes<W> weighted_z = weigh_z(), sum = add_edges();
    test.mask &= not_equal(sum, Lanes<W>(0.0f));
    if (const LaneMask lanes = find_doubtful_places(x, y, z, weighted_z, test)) [[unlikely]] {
        refine_edges(x, y, lanes, test);
        weighted_z = weigh_z(), sum = add_edges();
        test.mask &= not_equal(sum, Lanes<W>(0.0f));
    }
    test.t = weighted_z / sum;
    return test.mask;
}

template <size_t W>
RELIEF_INLINE LaneMask test_distances(const Lanes<W> (&x)[3], const Lanes<W> (&y)[3], const Lanes<W> (&z)[3],
                                      const RayState& ray, TriangleTest<W>& test) {
    find_places(x, y, z, test);
    test.t = test.t * Lanes<W>(ray.shear[2]);
    float t_min = ray.t_min, t_max = ray.t_max;
    if (ray.shift != 0) [[unlikely]] {
        test.t = test.t + Lanes<W>(ray.shift);
        t_min = ray.own_t_min, t_max = ray.own_t_max;
    }
    return test.mask &= less(Lanes<W>(t_min), test.t) & less_equal(test.t, Lanes<W>(t_max));
}

/// Vertices relative to the ray: sheared x and y, and z along the major axis. load(axis) gives coordinates.
template <size_t W, class Load>
RELIEF_INLINE void shear_vertices(Load load, const RayState& ray, Lanes<W>& x, Lanes<W>& y, Lanes<W>& z) {
    z = load(ray.axis[2]) - Lanes<W>(ray.origin[ray.axis[2]]);
    x = (load(ray.axis[0]) - Lanes<W>(ray.origin[ray.axis[0]])) - Lanes<W>(ray.shear[0]) * z;
    y = (load(ray.axis[1]) - Lanes<W>(ray.origin[ray.axis[1]])) - Lanes<W>(ray.shear[1]) * z;
}

/// Order of equally near hits: (instance, patch, j, i, upper), so that results are deterministic.
RELIEF_INLINE bool comes_before(const cpu::TraceHit& a, const cpu::TraceHit& b) {
    const auto rank = [](const cpu::TraceHit& h) {
        return uint64_t(h.j) << 17 | uint64_t(h.i) << 1 | h.is_upper;
    };
    return a.instance != b.instance ? a.instance < b.instance
           : a.patch != b.patch     ? a.patch < b.patch
                                    : rank(a) < rank(b);
}

/// Takes over a hit if it is nearer, or as near and first in that order.
RELIEF_INLINE void offer_hit(RayState& ray, const cpu::TraceHit& hit) {
    if (!(hit.t == ray.hit.t ? comes_before(hit, ray.hit) : hit.t < ray.hit.t)) return;
    ray.hit = hit;
    ray.shorten(hit.t);
}

/// What the ray found in a space of its own.
RELIEF_INLINE void take_over(RayState& ray, const RayState& found) {
    ray.hit = found.hit;
    ray.shorten(found.hit_t_max());
}

/// Offers the hits of a test; locate(lane, weight_b, weight_c, hit) sets cell, is_upper, u and v.
template <size_t W, class Locate>
RELIEF_INLINE void offer_hits(RayState& ray, const TriangleTest<W>& test, Locate locate) {
    alignas(64) float u[W], v[W], w[W], t[W];
    test.u.store(u), test.v.store(v), test.w.store(w), test.t.store(t);
    for (LaneMask mask = test.mask; mask; mask &= mask - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(mask));
        if (t[lane] > ray.hit_t_max()) continue;
        const float sum = u[lane] + v[lane] + w[lane];
        cpu::TraceHit hit;
        hit.t = t[lane], hit.instance = ray.instance, hit.lod_bias = ray.hit.lod_bias;
        locate(lane, v[lane] / sum, w[lane] / sum, hit);
        offer_hit(ray, hit);
    }
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
