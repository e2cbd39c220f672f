// Rays of a pinhole, in object space: projected to the plane at distance 1, each ray is a point.
#pragma once

#include "cpu/traversal/ray_bundle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Beyond this, on the plane, a point is so far aside that its depth may have lost its sign to rounding.
inline constexpr float kWidestBounds = 1e4f;

struct RayFrustum : RayBundle {
    static constexpr int kPairValues = 2;  ///< two shears
    static constexpr bool kIsWide = false; ///< its groups spread far beside what they meet

    Vec3f plane[4]; ///< normals of the sides of the pyramid that holds all rays, pointing inwards

    /// What the test of a ray against a triangle reads of it.
    float pair_value(int k, uint32_t ray) const { return shear[k][ray]; }
    /// What vertices are measured from before rays are sheared.
    Vec3f vertex_origin() const { return origin; }
};

/// The farthest depth that a group still asks about, after hits.
RELIEF_INLINE float find_farthest(const RayFrustum& frustum, uint32_t group) {
    const size_t at = group * kGroupSize;
    return reduce_max(Lanes16::load(frustum.rays->t + at) * Lanes16::load(frustum.dz_dt + at));
}

/// The sides of the pyramid about all rays, a margin outside of them.
RELIEF_INLINE void make_sides(RayFrustum& frustum) {
    const float left = frustum.lower_x[kGroupCount] - 2 * kBoundsMargin;
    const float right = frustum.upper_x[kGroupCount] + 2 * kBoundsMargin;
    const float bottom = frustum.lower_y[kGroupCount] - 2 * kBoundsMargin;
    const float top = frustum.upper_y[kGroupCount] + 2 * kBoundsMargin;
    frustum.plane[0] = frustum.right - frustum.forward * left;
    frustum.plane[1] = frustum.forward * right - frustum.right;
    frustum.plane[2] = frustum.up - frustum.forward * bottom;
    frustum.plane[3] = frustum.forward * top - frustum.up;
}

/// Takes the rays into another space. False where they diverge too much there, or have different major axes.
RELIEF_INLINE bool enter_space(const ObjectSpace& space, RayFrustum& frustum) {
    const BundleRays& rays = *frustum.rays;
    const Affine& from_origin = space.from_origin;
    frustum.origin = space.place(rays.origin);
    const auto direction = [&](uint32_t k) {
        return normalize(transform_vector(from_origin, rays.direction_of(k)));
    };
    // Axes along the rows that rays come in.
    choose_axes(find_forward(from_origin, rays), direction(HWY_MIN(3u, rays.count - 1)) - direction(0),
                frustum);
    if (!choose_major_axis(from_origin, frustum)) return false;
    for (uint32_t group = 0; group < kGroupCount; ++group) {
        Lanes16 d[3], rcp_dz_dt;
        transform_directions(rays, from_origin, group * kGroupSize, d);
        if (!store_directions(d, group * kGroupSize, frustum, rcp_dz_dt)) return false;
        store_range(dot_lanes(d, frustum.right) * rcp_dz_dt, dot_lanes(d, frustum.up) * rcp_dz_dt, group,
                    frustum);
        frustum.farthest[group] = find_farthest(frustum, group);
    }
    join_ranges(frustum);
    make_sides(frustum);
    return true;
}

/// The boxes that reach into the pyramid, and the least depth of each.
template <size_t W>
RELIEF_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const RayFrustum& frustum, Lanes<W>& nearest) {
    const RelativeBoxes<W> box(bound, frustum.origin);
    const Lanes<W> least = Lanes<W>(0.0f) - box.reach * Lanes<W>(kBoxMargin);
    nearest = least - find_greatest(box.bound, -frustum.forward);
    LaneMask mask = less_equal(nearest * Lanes<W>(kDepthSlack), Lanes<W>(frustum.farthest[kGroupCount])) &
                    less_equal(least, find_greatest(box.bound, frustum.forward));
    for (const Vec3f& side : frustum.plane) mask &= less_equal(least, find_greatest(box.bound, side));
    return mask;
}

/// Points relative to the origin.
template <size_t W> RELIEF_INLINE Projected<W> project(const Lanes<W> (&v)[3], const RayFrustum& frustum) {
    const Lanes<W> depth = dot_lanes(v, frustum.forward), inverse = Lanes<W>(1.0f) / depth;
    return {dot_lanes(v, frustum.right) * inverse, dot_lanes(v, frustum.up) * inverse, depth};
}

/// Widens bounds of points by rounding. What is not in front of the rays, or far aside, is unbounded.
RELIEF_INLINE void widen_bounds(const RayFrustum&, ProjectedBounds& bounds) {
    const bool is_in_front = bounds.depth > 0 && bounds.lower_x > -kWidestBounds &&
                             bounds.upper_x < kWidestBounds && bounds.lower_y > -kWidestBounds &&
                             bounds.upper_y < kWidestBounds;
    if (!is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        bounds = {-kEnd, kEnd, -kEnd, kEnd, -kEnd, kEnd};
        return;
    }
    const float aside =
        HWY_MAX(HWY_MAX(-bounds.lower_x, bounds.upper_x), HWY_MAX(-bounds.lower_y, bounds.upper_y));
    const float margin = kBoundsMargin * HWY_MAX(1.0f, aside);
    bounds.lower_x -= margin, bounds.upper_x += margin, bounds.lower_y -= margin, bounds.upper_y += margin;
    bounds.depth *= kDepthSlack - margin;
}

/// The same for eight parts. All are unbounded where one of them is not in front, or far aside. Parts that
/// are not numbers are not there; a ray that is tested against one nevertheless misses it.
RELIEF_INLINE void widen_bounds(const RayFrustum&, PartBounds& part) {
    const LaneMask is_there = less_equal(part.depth, part.depth);
    const LaneMask is_in_front = less(Lanes8(0.0f), part.depth) & less(Lanes8(-kWidestBounds), part.lower_x) &
                                 less(part.upper_x, Lanes8(kWidestBounds)) &
                                 less(Lanes8(-kWidestBounds), part.lower_y) &
                                 less(part.upper_y, Lanes8(kWidestBounds));
    if (is_there != is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        const Lanes8 least(-kEnd), greatest(kEnd);
        part = {least, greatest, least, greatest, least, greatest};
        return;
    }
    const Lanes8 zero(0.0f);
    const Lanes8 aside = max(max(zero - part.lower_x, part.upper_x), max(zero - part.lower_y, part.upper_y));
    const Lanes8 margin = Lanes8(kBoundsMargin) * max(Lanes8(1.0f), aside);
    part.lower_x = part.lower_x - margin, part.upper_x = part.upper_x + margin;
    part.lower_y = part.lower_y - margin, part.upper_y = part.upper_y + margin;
    part.depth = part.depth * (Lanes8(kDepthSlack) - margin);
}

template <size_t W, class Get>
RELIEF_INLINE RayRanges<W> find_ranges(const RayFrustum& frustum, const ProjectedLanes<W>&, Get get) {
    return {get(frustum.lower_x), get(frustum.upper_x), get(frustum.lower_y), get(frustum.upper_y),
            get(frustum.farthest)};
}
template <size_t W, class Get>
RELIEF_INLINE RayRanges<W> find_places(const RayFrustum& frustum, const ProjectedLanes<W>&, Get get) {
    const Lanes<W> x = get(frustum.x), y = get(frustum.y);
    return {x, x, y, y, get(frustum.rays->t) * get(frustum.dz_dt)};
}

/// Sixteen rays as the bounds see them.
struct FrustumLanes {
    RayRanges<16> places;
    Lanes16 pair_value[RayFrustum::kPairValues];

    RELIEF_INLINE LaneMask find_inside(const ProjectedBounds& bounds) const {
        return places.overlap(spread<16>(bounds));
    }
};
RELIEF_INLINE FrustumLanes load_lanes(const RayFrustum& frustum, uint32_t group) {
    const auto get = [&](const float* of_rays) { return Lanes16::load(of_rays + group * kGroupSize); };
    return {find_places(frustum, ProjectedLanes<16>{}, get), {get(frustum.shear[0]), get(frustum.shear[1])}};
}

/// Corners of sixteen triangles or quads, one of a pair's each, relative to the ray: x and y as the ray sees
/// them, z along its major axis. `value` is pair_value of the rays; `v` is relative to the frustum's origin.
RELIEF_INLINE void shear_corner(const Lanes16 (&value)[RayFrustum::kPairValues], Lanes16 (&v)[3]) {
    v[0] = v[0] - value[0] * v[2];
    v[1] = v[1] - value[1] * v[2];
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
