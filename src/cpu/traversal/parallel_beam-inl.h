// Rays of about one direction from different origins in an object's space: those through a lens. Seen along
// their mean direction, in parallel, a ray is a line: at a depth at x + (depth - pivot) * slope.
#pragma once

#include "cpu/traversal/ray_bundle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Rays begin at depths >= 0.
struct ParallelBeam : RayBundle {
    static constexpr int kPairValues = 5; ///< two shears, and the origin by RayBundle::axis
    static constexpr bool kIsWide = true; ///< its groups spread far beside what they meet

    float pivot;                  ///< depth at which the rays lie closest together
    float extent;                 ///< greatest |x|, |y| or |depth| of where rays begin, or are closest
    float steepest_x, steepest_y; ///< greatest |slope|
    alignas(64) float from[3][kBundleSize];
    alignas(64) float start[kBundleSize]; ///< depth of the origin
    alignas(64) float slope_x[kBundleSize], slope_y[kBundleSize];
    alignas(64) float lower_slope_x[kRangeCount], upper_slope_x[kRangeCount];
    alignas(64) float lower_slope_y[kRangeCount], upper_slope_y[kRangeCount];

    /// What the test of a ray against a triangle reads of it.
    float pair_value(int k, uint32_t ray) const { return k < 2 ? shear[k][ray] : from[axis[k - 2]][ray]; }
    /// What vertices are measured from before rays are sheared.
    Vec3f vertex_origin() const { return {}; }
};

/// The depths to which sixteen rays still ask, after hits.
RELIEF_INLINE Lanes16 find_ends(const ParallelBeam& beam, uint32_t group) {
    const size_t at = group * kGroupSize;
    return Lanes16::load(beam.start + at) + Lanes16::load(beam.rays->t + at) * Lanes16::load(beam.dz_dt + at);
}
RELIEF_INLINE float find_farthest(const ParallelBeam& beam, uint32_t group) {
    return reduce_max(find_ends(beam, group));
}

/// Origins into the space, by the operations of ObjectSpace::place, and where depth 0 is.
RELIEF_INLINE void place_origins(const ObjectSpace& space, ParallelBeam& beam) {
    const BundleRays& rays = *beam.rays;
    const Vec3f &t = space.from_origin.translation, &o = space.origin;
    const float translation[3] = {t.x, t.y, t.z}, origin[3] = {o.x, o.y, o.z};
    const Vec3f first = space.place(rays.origin_of(0));
    const float base[3] = {first.x, first.y, first.z};
    Lanes16 depth(0.0f);
    for (size_t at = 0; at < kBundleSize; at += kGroupSize) {
        Lanes16 world[3], relative[3];
        for (int k = 0; k < 3; ++k) world[k] = Lanes16::load(rays.from[k] + at) - Lanes16(origin[k]);
        for (size_t k = 0; k < 3; ++k) {
            const Lanes16 place = dot_lanes(world, space.from_origin.rows[k]) + Lanes16(translation[k]);
            place.store(beam.from[k] + at);
            relative[k] = place - Lanes16(base[k]);
        }
        depth = min(depth, dot_lanes(relative, beam.forward));
    }
    // So far before them that no rounding of the origin brings it behind one.
    const float least = reduce_min(depth);
    const float pad = 1e-6f * (std::fabs(first.x) + std::fabs(first.y) + std::fabs(first.z) - least);
    beam.origin = first + beam.forward * (least - pad);
}

/// Sizes of two coordinates into the extent. False for NaN, and where places on the plane would be NaN.
RELIEF_INLINE bool extend(const Lanes16& a, const Lanes16& b, Lanes16& extent) {
    const Lanes16 size_a = magnitude(a), size_b = magnitude(b);
    extent = max(extent, max(size_a, size_b));
    return less(size_a + size_b, Lanes16(1e18f)) == 0xffff;
}

/// The sums that the depth follows from at which lines lie closest together, in the mean of squares.
struct PivotSums {
    Lanes16 place_slope[2], place[2], slope[2], slope2;

    PivotSums() : slope2(0.0f) {
        for (int k = 0; k < 2; ++k) place_slope[k] = place[k] = slope[k] = slope2;
    }
    RELIEF_INLINE void add(const Lanes16& x, int k, const Lanes16& slope_x) {
        place_slope[k] = place_slope[k] + x * slope_x, place[k] = place[k] + x;
        slope[k] = slope[k] + slope_x, slope2 = slope2 + slope_x * slope_x;
    }
    RELIEF_INLINE float find_depth() const {
        constexpr float kShare = 1.0f / kBundleSize;
        float covariance = 0, variance = reduce_sum(slope2);
        for (int k = 0; k < 2; ++k) {
            const float mean = reduce_sum(slope[k]) * kShare;
            covariance += reduce_sum(place_slope[k]) - reduce_sum(place[k]) * mean;
            variance -= reduce_sum(slope[k]) * mean;
        }
        const float depth = -covariance / variance;
        return variance > 1e-9f && depth > 0 && depth < 1e18f ? depth : 0.0f;
    }
};

/// Sixteen rays as lines, x and y at depth 0. False for several major axes or rays that go backward.
RELIEF_INLINE bool enter_group(const Affine& from_origin, uint32_t group, ParallelBeam& beam, Lanes16& extent,
                               PivotSums& sums) {
    const size_t at = group * kGroupSize;
    const float origin[3] = {beam.origin.x, beam.origin.y, beam.origin.z};
    Lanes16 d[3], o[3], rcp_dz_dt;
    transform_directions(*beam.rays, from_origin, at, d);
    if (!store_directions(d, at, beam, rcp_dz_dt)) return false;
    for (int k = 0; k < 3; ++k) o[k] = Lanes16::load(beam.from[k] + at) - Lanes16(origin[k]);
    const Lanes16 x = dot_lanes(o, beam.right), y = dot_lanes(o, beam.up);
    const Lanes16 start = dot_lanes(o, beam.forward);
    const Lanes16 slope_x = dot_lanes(d, beam.right) * rcp_dz_dt, slope_y = dot_lanes(d, beam.up) * rcp_dz_dt;
    start.store(beam.start + at), slope_x.store(beam.slope_x + at), slope_y.store(beam.slope_y + at);
    const Lanes16 place_x = x - start * slope_x, place_y = y - start * slope_y;
    place_x.store(beam.x + at), place_y.store(beam.y + at);
    sums.add(place_x, 0, slope_x), sums.add(place_y, 1, slope_y);
    const bool has_slopes = less(magnitude(slope_x) + magnitude(slope_y), Lanes16(4.0f)) == 0xffff;
    return has_slopes && extend(x, y, extent) && extend(start, start, extent) &&
           extend(place_x, place_y, extent);
}

/// Ranges of a group, places at the pivot from now on. False as of enter_group.
RELIEF_INLINE bool place_group(uint32_t group, ParallelBeam& beam, Lanes16& extent) {
    const size_t at = group * kGroupSize;
    const Lanes16 slope_x = Lanes16::load(beam.slope_x + at), slope_y = Lanes16::load(beam.slope_y + at);
    const Lanes16 x = Lanes16::load(beam.x + at) + slope_x * Lanes16(beam.pivot);
    const Lanes16 y = Lanes16::load(beam.y + at) + slope_y * Lanes16(beam.pivot);
    beam.lower_slope_x[group] = reduce_min(slope_x), beam.upper_slope_x[group] = reduce_max(slope_x);
    beam.lower_slope_y[group] = reduce_min(slope_y), beam.upper_slope_y[group] = reduce_max(slope_y);
    store_range(x, y, group, beam);
    beam.farthest[group] = find_farthest(beam, group);
    return extend(x, y, extent);
}

/// Takes the rays into another space. False where they diverge too much there, or have different major axes.
RELIEF_INLINE bool enter_space(const ObjectSpace& space, ParallelBeam& beam) {
    const BundleRays& rays = *beam.rays;
    const Affine& from_origin = space.from_origin;
    const uint32_t near = HWY_MIN(3u, rays.count - 1);
    const Vec3f along = (rays.origin_of(near) - rays.origin_of(0)) +
                        (normalize(rays.direction_of(near)) - normalize(rays.direction_of(0)));
    choose_axes(find_forward(from_origin, rays), transform_vector(from_origin, along), beam);
    if (!choose_major_axis(from_origin, beam)) return false;
    place_origins(space, beam);
    Lanes16 extent(0.0f);
    PivotSums sums;
    for (uint32_t group = 0; group < kGroupCount; ++group)
        if (!enter_group(from_origin, group, beam, extent, sums)) return false;
    // Farther away lines spread with the depth, whatever the pivot, and places lose digits.
    beam.pivot = HWY_MIN(sums.find_depth(), 1e3f * reduce_max(extent));
    for (uint32_t group = 0; group < kGroupCount; ++group)
        if (!place_group(group, beam, extent)) return false;
    beam.extent = HWY_MAX(reduce_max(extent), beam.pivot);
    join_ranges(beam);
    join_lower(beam.lower_slope_x), join_upper(beam.upper_slope_x);
    join_lower(beam.lower_slope_y), join_upper(beam.upper_slope_y);
    beam.steepest_x = HWY_MAX(-beam.lower_slope_x[kGroupCount], beam.upper_slope_x[kGroupCount]);
    beam.steepest_y = HWY_MAX(-beam.lower_slope_y[kGroupCount], beam.upper_slope_y[kGroupCount]);
    return true;
}

/// Widens bounds by rounding, and by how far rays move from the middle of one to an end.
template <class T> RELIEF_INLINE void widen(const ParallelBeam& beam, const T& margin, BoundsOf<T>& bounds) {
    const T half = T(0.5f) * (bounds.far - bounds.depth);
    const T x = margin + T(beam.steepest_x) * half, y = margin + T(beam.steepest_y) * half;
    bounds.lower_x = bounds.lower_x - x, bounds.upper_x = bounds.upper_x + x;
    bounds.lower_y = bounds.lower_y - y, bounds.upper_y = bounds.upper_y + y;
    bounds.depth = bounds.depth - margin, bounds.far = bounds.far + margin;
}

/// ProjectedLanes of W boxes.
template <size_t W>
RELIEF_INLINE ProjectedLanes<W> find_box_bounds(const Lanes<W> (&bound)[6], const ParallelBeam& beam) {
    const RelativeBoxes<W> box(bound, beam.origin);
    const Lanes<W> zero(0.0f);
    const auto least = [&](const Vec3f& n) { return zero - find_greatest(box.bound, -n); };
    ProjectedLanes<W> bounds = {least(beam.right),   find_greatest(box.bound, beam.right),
                                least(beam.up),      find_greatest(box.bound, beam.up),
                                least(beam.forward), find_greatest(box.bound, beam.forward)};
    widen(beam, (box.reach + Lanes<W>(beam.extent)) * Lanes<W>(kBoundsMargin), bounds);
    return bounds;
}

/// Lines of slopes between two bounds and places between two, at the middle depth.
template <size_t W, class Get>
RELIEF_INLINE RayRanges<W> find_ranges(const ParallelBeam& beam, const ProjectedLanes<W>& bounds, Get get) {
    const Lanes<W> middle = bounds.middle() - Lanes<W>(beam.pivot);
    const Lanes<W> x0 = get(beam.lower_slope_x) * middle, x1 = get(beam.upper_slope_x) * middle;
    const Lanes<W> y0 = get(beam.lower_slope_y) * middle, y1 = get(beam.upper_slope_y) * middle;
    return {get(beam.lower_x) + min(x0, x1), get(beam.upper_x) + max(x0, x1), get(beam.lower_y) + min(y0, y1),
            get(beam.upper_y) + max(y0, y1), get(beam.farthest)};
}
template <size_t W, class Get>
RELIEF_INLINE RayRanges<W> find_places(const ParallelBeam& beam, const ProjectedLanes<W>& bounds, Get get) {
    const Lanes<W> middle = bounds.middle() - Lanes<W>(beam.pivot);
    const Lanes<W> x = get(beam.x) + get(beam.slope_x) * middle, y = get(beam.y) + get(beam.slope_y) * middle;
    return {x, x, y, y, get(beam.start) + get(beam.rays->t) * get(beam.dz_dt)};
}

/// Points relative to the origin.
template <size_t W> RELIEF_INLINE Projected<W> project(const Lanes<W> (&v)[3], const ParallelBeam& beam) {
    return {dot_lanes(v, beam.right), dot_lanes(v, beam.up), dot_lanes(v, beam.forward)};
}

/// The same of points, or of eight parts. Those that are NaN no ray lies in.
template <class T> RELIEF_INLINE void widen_bounds(const ParallelBeam& beam, BoundsOf<T>& bounds) {
    const T zero(0.0f);
    const T aside =
        max(max(zero - bounds.lower_x, bounds.upper_x), max(zero - bounds.lower_y, bounds.upper_y));
    widen(beam, T(kBoundsMargin) * (max(aside, max(zero - bounds.depth, bounds.far)) + T(beam.extent)),
          bounds);
}

/// The boxes that a group of rays may enter, and the least depth of each.
template <size_t W>
RELIEF_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const ParallelBeam& beam, Lanes<W>& nearest) {
    const ProjectedLanes<W> bounds = find_box_bounds(bound, beam);
    nearest = bounds.depth;
    LaneMask mask = find_parts_of_group(bounds, beam, kGroupCount) & less_equal(Lanes<W>(0.0f), bounds.far);
    alignas(64) float lower_x[W], upper_x[W], lower_y[W], upper_y[W], depth[W], far[W];
    bounds.lower_x.store(lower_x), bounds.upper_x.store(upper_x);
    bounds.lower_y.store(lower_y), bounds.upper_y.store(upper_y);
    bounds.depth.store(depth), bounds.far.store(far);
    for (LaneMask left = mask; left; left &= left - 1) {
        const uint32_t k = uint32_t(__builtin_ctz(left));
        if (!find_groups({lower_x[k], upper_x[k], lower_y[k], upper_y[k], depth[k], far[k]}, beam))
            mask &= ~(1u << k);
    }
    return mask;
}

/// Sixteen rays as the bounds see them.
struct BeamLanes {
    float pivot;
    Lanes16 x, y, slope_x, slope_y, end;
    Lanes16 pair_value[ParallelBeam::kPairValues];

    RELIEF_INLINE LaneMask find_inside(const ProjectedBounds& bounds) const {
        const Lanes16 middle(bounds.middle() - pivot);
        const Lanes16 at_x = x + slope_x * middle, at_y = y + slope_y * middle;
        return RayRanges<16>{at_x, at_x, at_y, at_y, end}.overlap(spread<16>(bounds));
    }
};
RELIEF_INLINE BeamLanes load_lanes(const ParallelBeam& beam, uint32_t group) {
    const auto get = [&](const float* of_rays) { return Lanes16::load(of_rays + group * kGroupSize); };
    const auto get_from = [&](int k) { return get(beam.from[beam.axis[k]]); };
    return {beam.pivot,
            get(beam.x),
            get(beam.y),
            get(beam.slope_x),
            get(beam.slope_y),
            find_ends(beam, group),
            {get(beam.shear[0]), get(beam.shear[1]), get_from(0), get_from(1), get_from(2)}};
}

/// As of a RayFrustum; `v` is as it lies in the space, the major axis last.
RELIEF_INLINE void shear_corner(const Lanes16 (&value)[ParallelBeam::kPairValues], Lanes16 (&v)[3]) {
    v[2] = v[2] - value[4];
    v[0] = (v[0] - value[2]) - value[0] * v[2];
    v[1] = (v[1] - value[3]) - value[1] * v[2];
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
