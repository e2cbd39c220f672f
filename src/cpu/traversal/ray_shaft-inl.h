// Rays that go about the same way from places of their own, in the space of one object: those through a lens.
// They are seen along their mean direction, in parallel: there a ray is a line whose place at a
// depth is x + (depth - pivot) * slope.
#if defined(RELIEF_RAY_SHAFT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RAY_SHAFT_INL_H
#undef RELIEF_RAY_SHAFT_INL_H
#else
#define RELIEF_RAY_SHAFT_INL_H
#endif

#include "cpu/traversal/ray_bundle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Rays begin at depths >= 0.
struct RayShaft : RayBundle {
    static constexpr int kPairValues = 5; ///< two shears, and the origin by RayBundle::axis
    static constexpr bool kIsWide = true; ///< its groups spread far beside what they meet

    float pivot;                  ///< depth at which the rays lie closest together
    float extent;                 ///< greatest |x|, |y| or |depth| of where rays begin, or are closest
    float steepest_x, steepest_y; ///< greatest |slope|
    float all[4], slopes[4];      ///< ranges of x and of y, and of their slopes: lower, upper, lower, upper
    alignas(64) float from[3][kBundleSize];
    alignas(64) float start[kBundleSize]; ///< depth of the origin
    alignas(64) float slope_x[kBundleSize], slope_y[kBundleSize];
    alignas(64) float lower_slope_x[kGroupCount], upper_slope_x[kGroupCount];
    alignas(64) float lower_slope_y[kGroupCount], upper_slope_y[kGroupCount];

    /// What the test of a ray against a triangle reads of it.
    float pair_value(int k, uint32_t ray) const { return k < 2 ? shear[k][ray] : from[axis[k - 2]][ray]; }
    /// What vertices are measured from before rays are sheared.
    Vec3f vertex_origin() const { return {}; }
};

/// The depths to which sixteen rays still ask, after hits.
HWY_INLINE Lanes16 find_ends(const RayShaft& shaft, uint32_t group) {
    const size_t at = group * kGroupSize;
    return Lanes16::load(shaft.start + at) +
           Lanes16::load(shaft.rays->t + at) * Lanes16::load(shaft.speed + at);
}
HWY_INLINE float find_farthest(const RayShaft& shaft, uint32_t group) {
    return reduce_max(find_ends(shaft, group));
}

/// Origins into the space, by the operations of transform_point, and where depth 0 is.
HWY_INLINE void place_origins(const Affine& object_from_world, RayShaft& shaft) {
    const BundleRays& rays = *shaft.rays;
    const Vec3f& t = object_from_world.translation;
    const float translation[3] = {t.x, t.y, t.z};
    const Vec3f first = transform_point(object_from_world, rays.origin_of(0));
    const float base[3] = {first.x, first.y, first.z};
    Lanes16 depth(0.0f);
    for (size_t at = 0; at < kBundleSize; at += kGroupSize) {
        Lanes16 world[3], relative[3];
        for (int k = 0; k < 3; ++k) world[k] = Lanes16::load(rays.from[k] + at);
        for (size_t k = 0; k < 3; ++k) {
            const Lanes16 place = dot_lanes(world, object_from_world.rows[k]) + Lanes16(translation[k]);
            place.store(shaft.from[k] + at);
            relative[k] = place - Lanes16(base[k]);
        }
        depth = min(depth, dot_lanes(relative, shaft.forward));
    }
    // So far before them that no rounding of the origin brings it behind one.
    const float least = reduce_min(depth);
    const float pad = 1e-6f * (std::fabs(first.x) + std::fabs(first.y) + std::fabs(first.z) - least);
    shaft.origin = first + shaft.forward * (least - pad);
}

HWY_INLINE Lanes16 find_size(const Lanes16& a) { return max(a, Lanes16(0.0f) - a); }

/// Sizes of two coordinates into the extent. False where one is no number, or so large that places on the
/// plane would be none.
HWY_INLINE bool extend(const Lanes16& a, const Lanes16& b, Lanes16& extent) {
    const Lanes16 size_a = find_size(a), size_b = find_size(b);
    extent = max(extent, max(size_a, size_b));
    return less(size_a + size_b, Lanes16(1e18f)) == 0xffff;
}

/// The sums that the depth follows from at which lines lie closest together, in the mean of squares.
struct PivotSums {
    Lanes16 place_slope[2], place[2], slope[2], slope2;

    PivotSums() : slope2(0.0f) {
        for (int k = 0; k < 2; ++k) place_slope[k] = place[k] = slope[k] = slope2;
    }
    HWY_INLINE void add(const Lanes16& x, int k, const Lanes16& slope_x) {
        place_slope[k] = place_slope[k] + x * slope_x, place[k] = place[k] + x;
        slope[k] = slope[k] + slope_x, slope2 = slope2 + slope_x * slope_x;
    }
    HWY_INLINE float find_depth() const {
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

/// Sixteen rays as lines, x and y still those of depth 0. False where they do not go forward, or along
/// several major axes.
HWY_INLINE bool enter_group(const Affine& object_from_world, uint32_t group, RayShaft& shaft, Lanes16& extent,
                            PivotSums& sums) {
    const size_t at = group * kGroupSize;
    const float origin[3] = {shaft.origin.x, shaft.origin.y, shaft.origin.z};
    Lanes16 d[3], o[3], closeness;
    transform_directions(*shaft.rays, object_from_world, at, d);
    if (!store_directions(d, at, shaft, closeness)) return false;
    for (int k = 0; k < 3; ++k) o[k] = Lanes16::load(shaft.from[k] + at) - Lanes16(origin[k]);
    const Lanes16 x = dot_lanes(o, shaft.right), y = dot_lanes(o, shaft.up);
    const Lanes16 start = dot_lanes(o, shaft.forward);
    const Lanes16 slope_x = dot_lanes(d, shaft.right) * closeness,
                  slope_y = dot_lanes(d, shaft.up) * closeness;
    start.store(shaft.start + at), slope_x.store(shaft.slope_x + at), slope_y.store(shaft.slope_y + at);
    const Lanes16 place_x = x - start * slope_x, place_y = y - start * slope_y;
    place_x.store(shaft.x + at), place_y.store(shaft.y + at);
    sums.add(place_x, 0, slope_x), sums.add(place_y, 1, slope_y);
    const bool has_slopes = less(find_size(slope_x) + find_size(slope_y), Lanes16(4.0f)) == 0xffff;
    return has_slopes && extend(x, y, extent) && extend(start, start, extent) &&
           extend(place_x, place_y, extent);
}

/// Ranges of a group, places at the pivot from now on. False as of enter_group.
HWY_INLINE bool place_group(uint32_t group, RayShaft& shaft, Lanes16& extent) {
    const size_t at = group * kGroupSize;
    const Lanes16 slope_x = Lanes16::load(shaft.slope_x + at), slope_y = Lanes16::load(shaft.slope_y + at);
    const Lanes16 x = Lanes16::load(shaft.x + at) + slope_x * Lanes16(shaft.pivot);
    const Lanes16 y = Lanes16::load(shaft.y + at) + slope_y * Lanes16(shaft.pivot);
    shaft.lower_slope_x[group] = reduce_min(slope_x), shaft.upper_slope_x[group] = reduce_max(slope_x);
    shaft.lower_slope_y[group] = reduce_min(slope_y), shaft.upper_slope_y[group] = reduce_max(slope_y);
    store_range(x, y, group, shaft);
    shaft.group_farthest[group] = find_farthest(shaft, group);
    return extend(x, y, extent);
}

/// Ranges of all rays.
HWY_INLINE void make_ranges(RayShaft& shaft) {
    const auto least = [](const float(&of)[kGroupCount]) { return reduce_min(Lanes16::load(of)); };
    const auto greatest = [](const float(&of)[kGroupCount]) { return reduce_max(Lanes16::load(of)); };
    shaft.all[0] = least(shaft.lower_x), shaft.all[1] = greatest(shaft.upper_x);
    shaft.all[2] = least(shaft.lower_y), shaft.all[3] = greatest(shaft.upper_y);
    shaft.slopes[0] = least(shaft.lower_slope_x), shaft.slopes[1] = greatest(shaft.upper_slope_x);
    shaft.slopes[2] = least(shaft.lower_slope_y), shaft.slopes[3] = greatest(shaft.upper_slope_y);
    shaft.steepest_x = HWY_MAX(-shaft.slopes[0], shaft.slopes[1]);
    shaft.steepest_y = HWY_MAX(-shaft.slopes[2], shaft.slopes[3]);
}

/// Takes the rays into another space. False where they diverge too much there, or have different major axes.
HWY_INLINE bool enter_space(const Affine& object_from_world, RayShaft& shaft) {
    const BundleRays& rays = *shaft.rays;
    const uint32_t near = HWY_MIN(3u, rays.count - 1);
    const Vec3f along = (rays.origin_of(near) - rays.origin_of(0)) +
                        (normalize(rays.direction_of(near)) - normalize(rays.direction_of(0)));
    choose_axes(find_forward(object_from_world, rays), transform_vector(object_from_world, along), shaft);
    if (!choose_major_axis(object_from_world, shaft)) return false;
    place_origins(object_from_world, shaft);
    Lanes16 extent(0.0f);
    PivotSums sums;
    for (uint32_t group = 0; group < kGroupCount; ++group)
        if (!enter_group(object_from_world, group, shaft, extent, sums)) return false;
    // Farther away lines spread with the depth, whatever the pivot, and places lose digits.
    shaft.pivot = HWY_MIN(sums.find_depth(), 1e3f * reduce_max(extent));
    for (uint32_t group = 0; group < kGroupCount; ++group)
        if (!place_group(group, shaft, extent)) return false;
    shaft.extent = HWY_MAX(reduce_max(extent), shaft.pivot);
    make_ranges(shaft);
    update_farthest(shaft);
    return true;
}

/// Where W lines of slopes between two bounds and W places between two may be at W depths, from the pivot.
template <size_t W> struct LineRange {
    Lanes<W> lower, upper;

    HWY_INLINE LineRange(const Lanes<W>& lower_place, const Lanes<W>& upper_place,
                         const Lanes<W>& lower_slope, const Lanes<W>& upper_slope, const Lanes<W>& depth) {
        const Lanes<W> a = lower_slope * depth, b = upper_slope * depth;
        lower = lower_place + min(a, b), upper = upper_place + max(a, b);
    }
    HWY_INLINE LaneMask overlaps(const Lanes<W>& least, const Lanes<W>& greatest) const {
        return less_equal(least, upper) & less_equal(lower, greatest);
    }
};

/// Makes room in windows for rounding, and for how far rays move while they go from the middle of one to an
/// end.
template <size_t W> HWY_INLINE void widen(const RayShaft& shaft, const Lanes<W>& margin, Windows<W>& window) {
    const Lanes<W> half = Lanes<W>(0.5f) * (window.far - window.depth);
    const Lanes<W> x = margin + Lanes<W>(shaft.steepest_x) * half,
                   y = margin + Lanes<W>(shaft.steepest_y) * half;
    window.lower_x = window.lower_x - x, window.upper_x = window.upper_x + x;
    window.lower_y = window.lower_y - y, window.upper_y = window.upper_y + y;
    window.depth = window.depth - margin, window.far = window.far + margin;
}

/// Windows of W boxes.
template <size_t W>
HWY_INLINE Windows<W> find_box_windows(const Lanes<W> (&bound)[6], const RayShaft& shaft) {
    const RelativeBoxes<W> box(bound, shaft.origin);
    const Lanes<W> zero(0.0f);
    const auto least = [&](const Vec3f& n) { return zero - find_greatest(box.bound, -n); };
    Windows<W> window = {least(shaft.right),   find_greatest(box.bound, shaft.right),
                         least(shaft.up),      find_greatest(box.bound, shaft.up),
                         least(shaft.forward), find_greatest(box.bound, shaft.forward)};
    widen(shaft, (box.reach + Lanes<W>(shaft.extent)) * Lanes<W>(kWindowMargin), window);
    return window;
}

/// The windows that any ray may lie in.
template <size_t W> HWY_INLINE LaneMask find_inside(const Windows<W>& window, const RayShaft& shaft) {
    const Lanes<W> middle = window.middle() - Lanes<W>(shaft.pivot);
    const auto spread = [](float of_all) { return Lanes<W>(of_all); };
    const LineRange<W> x(spread(shaft.all[0]), spread(shaft.all[1]), spread(shaft.slopes[0]),
                         spread(shaft.slopes[1]), middle);
    const LineRange<W> y(spread(shaft.all[2]), spread(shaft.all[3]), spread(shaft.slopes[2]),
                         spread(shaft.slopes[3]), middle);
    return x.overlaps(window.lower_x, window.upper_x) & y.overlaps(window.lower_y, window.upper_y) &
           less_equal(Lanes<W>(0.0f), window.far) & less_equal(window.depth, Lanes<W>(shaft.farthest));
}

/// Points relative to the origin.
template <size_t W> HWY_INLINE Seen<W> look_at(const Lanes<W> (&v)[3], const RayShaft& shaft) {
    return {dot_lanes(v, shaft.right), dot_lanes(v, shaft.up), dot_lanes(v, shaft.forward)};
}

/// As `widen`, of one window of points.
HWY_INLINE void widen_window(const RayShaft& shaft, Window& window) {
    const float aside =
        HWY_MAX(HWY_MAX(-window.lower_x, window.upper_x), HWY_MAX(-window.lower_y, window.upper_y));
    const float margin = kWindowMargin * (HWY_MAX(aside, HWY_MAX(-window.depth, window.far)) + shaft.extent);
    const float half = 0.5f * (window.far - window.depth);
    const float x = margin + shaft.steepest_x * half, y = margin + shaft.steepest_y * half;
    window.lower_x -= x, window.upper_x += x, window.lower_y -= y, window.upper_y += y;
    window.depth -= margin, window.far += margin;
}

/// The same for eight parts. Those that are not numbers no ray lies in.
HWY_INLINE void widen_windows(const RayShaft& shaft, PartWindows& part) {
    const Lanes8 zero(0.0f);
    const Lanes8 aside = max(max(zero - part.lower_x, part.upper_x), max(zero - part.lower_y, part.upper_y));
    const Lanes8 margin =
        Lanes8(kWindowMargin) * (max(aside, max(zero - part.depth, part.far)) + Lanes8(shaft.extent));
    widen(shaft, margin, part);
}

/// The groups of rays that a window may concern.
HWY_INLINE LaneMask find_groups(const Window& window, const RayShaft& shaft) {
    const Lanes16 middle(window.middle() - shaft.pivot);
    const auto load = [](const float* of_groups) { return Lanes16::load(of_groups); };
    const LineRange<16> x(load(shaft.lower_x), load(shaft.upper_x), load(shaft.lower_slope_x),
                          load(shaft.upper_slope_x), middle);
    const LineRange<16> y(load(shaft.lower_y), load(shaft.upper_y), load(shaft.lower_slope_y),
                          load(shaft.upper_slope_y), middle);
    return x.overlaps(Lanes16(window.lower_x), Lanes16(window.upper_x)) &
           y.overlaps(Lanes16(window.lower_y), Lanes16(window.upper_y)) &
           less_equal(Lanes16(window.depth), load(shaft.group_farthest));
}

/// The boxes that a group of rays may enter, and the least depth of each.
template <size_t W>
HWY_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const RayShaft& shaft, Lanes<W>& nearest) {
    const Windows<W> windows = find_box_windows(bound, shaft);
    nearest = windows.depth;
    LaneMask mask = find_inside(windows, shaft);
    alignas(64) float lower_x[W], upper_x[W], lower_y[W], upper_y[W], depth[W], far[W];
    windows.lower_x.store(lower_x), windows.upper_x.store(upper_x);
    windows.lower_y.store(lower_y), windows.upper_y.store(upper_y);
    windows.depth.store(depth), windows.far.store(far);
    for (LaneMask left = mask; left; left &= left - 1) {
        const uint32_t k = uint32_t(__builtin_ctz(left));
        if (!find_groups({lower_x[k], upper_x[k], lower_y[k], upper_y[k], depth[k], far[k]}, shaft))
            mask &= ~(1u << k);
    }
    return mask;
}

/// The parts that any ray of a group may meet.
HWY_INLINE LaneMask find_parts_of_group(const PartWindows& part, const RayShaft& shaft, uint32_t group) {
    const Lanes8 middle = part.middle() - Lanes8(shaft.pivot);
    const auto spread = [&](const float* of_groups) { return Lanes8(of_groups[group]); };
    const LineRange<8> x(spread(shaft.lower_x), spread(shaft.upper_x), spread(shaft.lower_slope_x),
                         spread(shaft.upper_slope_x), middle);
    const LineRange<8> y(spread(shaft.lower_y), spread(shaft.upper_y), spread(shaft.lower_slope_y),
                         spread(shaft.upper_slope_y), middle);
    return x.overlaps(part.lower_x, part.upper_x) & y.overlaps(part.lower_y, part.upper_y) &
           less_equal(part.depth, Lanes8(shaft.group_farthest[group]));
}

/// The parts that one ray may meet.
HWY_INLINE LaneMask find_parts_of_ray(const PartWindows& part, const RayShaft& shaft, uint32_t ray) {
    const Lanes8 middle = part.middle() - Lanes8(shaft.pivot);
    const Lanes8 x = Lanes8(shaft.x[ray]) + Lanes8(shaft.slope_x[ray]) * middle;
    const Lanes8 y = Lanes8(shaft.y[ray]) + Lanes8(shaft.slope_y[ray]) * middle;
    const float end = shaft.start[ray] + shaft.rays->t[ray] * shaft.speed[ray];
    return less_equal(part.lower_x, x) & less_equal(x, part.upper_x) & less_equal(part.lower_y, y) &
           less_equal(y, part.upper_y) & less_equal(part.depth, Lanes8(end));
}

/// Sixteen rays as the windows see them.
struct ShaftLanes {
    float pivot;
    Lanes16 x, y, slope_x, slope_y, end;
    Lanes16 pair_value[RayShaft::kPairValues];

    HWY_INLINE ShaftLanes(const RayShaft& shaft, uint32_t group) {
        const size_t at = group * kGroupSize;
        pivot = shaft.pivot;
        x = Lanes16::load(shaft.x + at), y = Lanes16::load(shaft.y + at);
        slope_x = Lanes16::load(shaft.slope_x + at), slope_y = Lanes16::load(shaft.slope_y + at);
        end = find_ends(shaft, group);
        for (int k = 0; k < 2; ++k) pair_value[k] = Lanes16::load(shaft.shear[k] + at);
        for (int k = 0; k < 3; ++k) pair_value[2 + k] = Lanes16::load(shaft.from[shaft.axis[k]] + at);
    }
    HWY_INLINE LaneMask find_inside(const Window& window) const {
        const Lanes16 middle(window.middle() - pivot);
        const Lanes16 at_x = x + slope_x * middle, at_y = y + slope_y * middle;
        return less_equal(Lanes16(window.lower_x), at_x) & less_equal(at_x, Lanes16(window.upper_x)) &
               less_equal(Lanes16(window.lower_y), at_y) & less_equal(at_y, Lanes16(window.upper_y)) &
               less_equal(Lanes16(window.depth), end);
    }
};
HWY_INLINE ShaftLanes load_lanes(const RayShaft& shaft, uint32_t group) { return {shaft, group}; }

/// As of a RayFan; `v` is as it lies in the space, the major axis last.
HWY_INLINE void shear_corner(const Lanes16 (&value)[RayShaft::kPairValues], Lanes16 (&v)[3]) {
    v[2] = v[2] - value[4];
    v[0] = (v[0] - value[2]) - value[0] * v[2];
    v[1] = (v[1] - value[3]) - value[1] * v[2];
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
