// Rays from one point, in the space of one object: a pinhole camera's. Seen from there everything lies on a
// plane at distance 1, where each ray is a point.
#if defined(RELIEF_RAY_FAN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RAY_FAN_INL_H
#undef RELIEF_RAY_FAN_INL_H
#else
#define RELIEF_RAY_FAN_INL_H
#endif

#include "cpu/traversal/ray_bundle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Beyond this, on the plane, a point is so far aside that its depth may have lost its sign to rounding.
inline constexpr float kWidestWindow = 1e4f;

struct RayFan : RayBundle {
    static constexpr int kPairValues = 2;  ///< two shears
    static constexpr bool kIsWide = false; ///< its groups spread far beside what they meet

    Vec3f plane[4]; ///< normals of the sides of the pyramid that holds all rays, pointing inwards

    /// What the test of a ray against a triangle reads of it.
    float pair_value(int k, uint32_t ray) const { return shear[k][ray]; }
    /// What vertices are measured from before rays are sheared.
    Vec3f vertex_origin() const { return origin; }
};

/// The farthest depth that a group still asks about, after hits.
HWY_INLINE float find_farthest(const RayFan& fan, uint32_t group) {
    const size_t at = group * kGroupSize;
    return reduce_max(Lanes16::load(fan.rays->t + at) * Lanes16::load(fan.speed + at));
}

/// The sides of the pyramid about all rays, a margin outside of them.
HWY_INLINE void make_sides(RayFan& fan) {
    const float left = reduce_min(Lanes16::load(fan.lower_x)) - 2 * kWindowMargin;
    const float right = reduce_max(Lanes16::load(fan.upper_x)) + 2 * kWindowMargin;
    const float bottom = reduce_min(Lanes16::load(fan.lower_y)) - 2 * kWindowMargin;
    const float top = reduce_max(Lanes16::load(fan.upper_y)) + 2 * kWindowMargin;
    fan.plane[0] = fan.right - fan.forward * left;
    fan.plane[1] = fan.forward * right - fan.right;
    fan.plane[2] = fan.up - fan.forward * bottom;
    fan.plane[3] = fan.forward * top - fan.up;
}

/// Takes the rays into another space. False where they diverge too much there, or have different major axes.
HWY_INLINE bool enter_space(const Affine& object_from_world, RayFan& fan) {
    const BundleRays& rays = *fan.rays;
    fan.origin = transform_point(object_from_world, rays.origin);
    const auto direction = [&](uint32_t k) {
        return normalize(transform_vector(object_from_world, rays.direction_of(k)));
    };
    // Axes along the rows that rays come in.
    choose_axes(find_forward(object_from_world, rays), direction(HWY_MIN(3u, rays.count - 1)) - direction(0),
                fan);
    if (!choose_major_axis(object_from_world, fan)) return false;
    for (uint32_t group = 0; group < kGroupCount; ++group) {
        Lanes16 d[3], closeness;
        transform_directions(rays, object_from_world, group * kGroupSize, d);
        if (!store_directions(d, group * kGroupSize, fan, closeness)) return false;
        store_range(dot_lanes(d, fan.right) * closeness, dot_lanes(d, fan.up) * closeness, group, fan);
        fan.group_farthest[group] = find_farthest(fan, group);
    }
    make_sides(fan);
    update_farthest(fan);
    return true;
}

/// The boxes that reach into the pyramid, and the least depth of each.
template <size_t W>
HWY_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const RayFan& fan, Lanes<W>& nearest) {
    const RelativeBoxes<W> box(bound, fan.origin);
    const Lanes<W> least = Lanes<W>(0.0f) - box.reach * Lanes<W>(kBoxMargin);
    nearest = least - find_greatest(box.bound, -fan.forward);
    LaneMask mask = less_equal(nearest * Lanes<W>(kDepthSlack), Lanes<W>(fan.farthest)) &
                    less_equal(least, find_greatest(box.bound, fan.forward));
    for (const Vec3f& side : fan.plane) mask &= less_equal(least, find_greatest(box.bound, side));
    return mask;
}

/// Points relative to the origin.
template <size_t W> HWY_INLINE Seen<W> look_at(const Lanes<W> (&v)[3], const RayFan& fan) {
    const Lanes<W> depth = dot_lanes(v, fan.forward), inverse = Lanes<W>(1.0f) / depth;
    return {dot_lanes(v, fan.right) * inverse, dot_lanes(v, fan.up) * inverse, depth};
}

/// Makes room for rounding in a window of points. What is not in front of the rays, or far aside, may be seen
/// anywhere.
HWY_INLINE void widen_window(const RayFan&, Window& window) {
    const bool is_in_front = window.depth > 0 && window.lower_x > -kWidestWindow &&
                             window.upper_x < kWidestWindow && window.lower_y > -kWidestWindow &&
                             window.upper_y < kWidestWindow;
    if (!is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        window = {-kEnd, kEnd, -kEnd, kEnd, -kEnd, kEnd};
        return;
    }
    const float aside =
        HWY_MAX(HWY_MAX(-window.lower_x, window.upper_x), HWY_MAX(-window.lower_y, window.upper_y));
    const float margin = kWindowMargin * HWY_MAX(1.0f, aside);
    window.lower_x -= margin, window.upper_x += margin, window.lower_y -= margin, window.upper_y += margin;
    window.depth *= kDepthSlack - margin;
}

/// The same for eight parts. All windows are open where one of them is not in front, or far aside. Parts that
/// are not numbers are not there; a ray that is tested against one nevertheless misses it.
HWY_INLINE void widen_windows(const RayFan&, PartWindows& part) {
    const LaneMask is_there = less_equal(part.depth, part.depth);
    const LaneMask is_in_front = less(Lanes8(0.0f), part.depth) & less(Lanes8(-kWidestWindow), part.lower_x) &
                                 less(part.upper_x, Lanes8(kWidestWindow)) &
                                 less(Lanes8(-kWidestWindow), part.lower_y) &
                                 less(part.upper_y, Lanes8(kWidestWindow));
    if (is_there != is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        const Lanes8 least(-kEnd), greatest(kEnd);
        part = {least, greatest, least, greatest, least, greatest};
        return;
    }
    const Lanes8 zero(0.0f);
    const Lanes8 aside = max(max(zero - part.lower_x, part.upper_x), max(zero - part.lower_y, part.upper_y));
    const Lanes8 margin = Lanes8(kWindowMargin) * max(Lanes8(1.0f), aside);
    part.lower_x = part.lower_x - margin, part.upper_x = part.upper_x + margin;
    part.lower_y = part.lower_y - margin, part.upper_y = part.upper_y + margin;
    part.depth = part.depth * (Lanes8(kDepthSlack) - margin);
}

/// The groups of rays that a window may concern.
HWY_INLINE LaneMask find_groups(const Window& window, const RayFan& fan) {
    return less_equal(Lanes16(window.lower_x), Lanes16::load(fan.upper_x)) &
           less_equal(Lanes16::load(fan.lower_x), Lanes16(window.upper_x)) &
           less_equal(Lanes16(window.lower_y), Lanes16::load(fan.upper_y)) &
           less_equal(Lanes16::load(fan.lower_y), Lanes16(window.upper_y)) &
           less_equal(Lanes16(window.depth), Lanes16::load(fan.group_farthest));
}

/// The parts that any ray of a group may meet.
HWY_INLINE LaneMask find_parts_of_group(const PartWindows& part, const RayFan& fan, uint32_t group) {
    return less_equal(part.lower_x, Lanes8(fan.upper_x[group])) &
           less_equal(Lanes8(fan.lower_x[group]), part.upper_x) &
           less_equal(part.lower_y, Lanes8(fan.upper_y[group])) &
           less_equal(Lanes8(fan.lower_y[group]), part.upper_y) &
           less_equal(part.depth, Lanes8(fan.group_farthest[group]));
}

/// The parts that one ray may meet.
HWY_INLINE LaneMask find_parts_of_ray(const PartWindows& part, const RayFan& fan, uint32_t ray) {
    const Lanes8 x(fan.x[ray]), y(fan.y[ray]);
    return less_equal(part.lower_x, x) & less_equal(x, part.upper_x) & less_equal(part.lower_y, y) &
           less_equal(y, part.upper_y) & less_equal(part.depth, Lanes8(fan.rays->t[ray] * fan.speed[ray]));
}

/// Sixteen rays as the windows see them.
struct FanLanes {
    Lanes16 x, y, depth; ///< depth of the nearest hit
    Lanes16 pair_value[RayFan::kPairValues];

    HWY_INLINE FanLanes(const RayFan& fan, uint32_t group) {
        const size_t at = group * kGroupSize;
        x = Lanes16::load(fan.x + at), y = Lanes16::load(fan.y + at);
        depth = Lanes16::load(fan.rays->t + at) * Lanes16::load(fan.speed + at);
        for (int k = 0; k < RayFan::kPairValues; ++k) pair_value[k] = Lanes16::load(fan.shear[k] + at);
    }
    HWY_INLINE LaneMask find_inside(const Window& window) const {
        return less_equal(Lanes16(window.lower_x), x) & less_equal(x, Lanes16(window.upper_x)) &
               less_equal(Lanes16(window.lower_y), y) & less_equal(y, Lanes16(window.upper_y)) &
               less_equal(Lanes16(window.depth), depth);
    }
};
HWY_INLINE FanLanes load_lanes(const RayFan& fan, uint32_t group) { return {fan, group}; }

/// Corners of sixteen triangles or quads, one of a pair's each, relative to the ray: x and y as the ray sees
/// them, z along its major axis. `value` is pair_value of the rays; `v` is relative to the fan's origin.
HWY_INLINE void shear_corner(const Lanes16 (&value)[RayFan::kPairValues], Lanes16 (&v)[3]) {
    v[0] = v[0] - value[0] * v[2];
    v[1] = v[1] - value[1] * v[2];
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
