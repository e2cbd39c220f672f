// What rays that travel together have in the space of one object. On a plane, boxes and blocks have bounds
// that are tested once for all; each ray meets only blocks whose bounds hold it. Places on the plane depend
// on the kind: frustum (frustum-inl.h) or parallel beam (parallel_beam-inl.h).
//
// Bounds are conservative; hits are decided by triangle_test-inl.h, bit-identical to single-ray traversal.
#pragma once

#include "cpu/traversal/bundle_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Some sixty roundings of a place on the plane, of how far it and its rays lie from the middle.
inline constexpr float kBoundsMargin = 4e-6f;
/// The same for the place of a box beside a plane, of the greatest distance of the box along an axis.
inline constexpr float kBoxMargin = 2e-6f;
inline constexpr float kDepthSlack = 1 - 2e-5f;

RELIEF_INLINE float max(float a, float b) { return HWY_MAX(a, b); }

/// A part of the plane, and the depths between which it is seen: of one, or of as many as T has lanes.
template <class T> struct BoundsOf {
    T lower_x, upper_x, lower_y, upper_y, depth, far;
    T middle() const { return T(0.5f) * (depth + far); }
};
using ProjectedBounds = BoundsOf<float>;
template <size_t W> using ProjectedLanes = BoundsOf<Lanes<W>>;

template <size_t W> RELIEF_INLINE ProjectedLanes<W> spread(const ProjectedBounds& bounds) {
    return {Lanes<W>(bounds.lower_x), Lanes<W>(bounds.upper_x), Lanes<W>(bounds.lower_y),
            Lanes<W>(bounds.upper_y), Lanes<W>(bounds.depth),   Lanes<W>(bounds.far)};
}

/// Where rays or groups of rays are on the plane, and the depth that they still ask about, after hits.
template <size_t W> struct RayRanges {
    Lanes<W> lower_x, upper_x, lower_y, upper_y, farthest;

    RELIEF_INLINE LaneMask overlap(const ProjectedLanes<W>& bounds) const {
        return less_equal(bounds.lower_x, upper_x) & less_equal(lower_x, bounds.upper_x) &
               less_equal(bounds.lower_y, upper_y) & less_equal(lower_y, bounds.upper_y) &
               less_equal(bounds.depth, farthest);
    }
};

/// Those of the eight quads of a block, in the order of the lower triangles' lanes, or of eight triangles.
using PartBounds = ProjectedLanes<8>;

/// Sixteen or eight points as they are seen.
template <size_t W> struct Projected { Lanes<W> x, y, depth; };

struct RayBundle {
    BundleRays* rays;
    Vec3f origin;             ///< what depths are measured from
    Vec3f right, up, forward; ///< of the plane; orthonormal
    int axis[3];              ///< as in RayState; one choice for all rays
    uint32_t instance;
    alignas(64) float x[kBundleSize],
        y[kBundleSize];                   ///< where a ray meets the plane; of a beam, at its pivot
    alignas(64) float dz_dt[kBundleSize]; ///< depth for a length of t
    alignas(64) float shear[3][kBundleSize];
    // Of each group, then of all rays.
    alignas(64) float lower_x[kRangeCount], upper_x[kRangeCount], lower_y[kRangeCount], upper_y[kRangeCount];
    alignas(64) float farthest[kRangeCount]; ///< depth of the farthest nearest hit
};

/// From the ranges of groups to those of all rays.
RELIEF_INLINE void join_lower(float (&of_groups)[kRangeCount]) {
    of_groups[kGroupCount] = reduce_min(Lanes16::load(of_groups));
}
RELIEF_INLINE void join_upper(float (&of_groups)[kRangeCount]) {
    of_groups[kGroupCount] = reduce_max(Lanes16::load(of_groups));
}
RELIEF_INLINE void join_ranges(RayBundle& bundle) {
    join_lower(bundle.lower_x), join_upper(bundle.upper_x);
    join_lower(bundle.lower_y), join_upper(bundle.upper_y);
    join_upper(bundle.farthest);
}

/// Depths of groups after hits.
template <class Bundle> RELIEF_INLINE void update_groups(Bundle& bundle, LaneMask dirty) {
    if (!dirty) return;
    for (; dirty; dirty &= dirty - 1) {
        const uint32_t group = uint32_t(__builtin_ctz(dirty));
        bundle.farthest[group] = find_farthest(bundle, group);
    }
    join_upper(bundle.farthest);
}

/// Directions of sixteen rays in an object's space, by the operations of transform_vector.
RELIEF_INLINE void transform_directions(const BundleRays& rays, const Affine& from_origin, size_t at,
                                        Lanes16 (&d)[3]) {
    Lanes16 world[3];
    for (int k = 0; k < 3; ++k) world[k] = Lanes16::load(rays.direction[k] + at);
    for (size_t k = 0; k < 3; ++k) d[k] = dot_lanes(world, from_origin.rows[k]);
}

/// Axes of a plane that faces `forward`, one of them about along `along`.
RELIEF_INLINE void choose_axes(const Vec3f& forward, const Vec3f& along, RayBundle& bundle) {
    bundle.forward = forward;
    Vec3f right = along - forward * dot(along, forward);
    if (!(dot(right, right) > 1e-6f * dot(along, along)))
        right =
            std::fabs(forward.x) > 0.5f ? Vec3f{-forward.y, forward.x, 0} : Vec3f{0, -forward.z, forward.y};
    bundle.right = normalize(right);
    bundle.up = cross(forward, bundle.right);
}

/// Which lanes have |a| > |b|.
RELIEF_INLINE LaneMask is_longer(const Lanes16& a, const Lanes16& b) {
    return less(magnitude(b), magnitude(a));
}

/// The major axis of sixteen directions by the choice of enter_object; 3 if they differ.
RELIEF_INLINE int find_major_axis(const Lanes16 (&d)[3]) {
    const LaneMask x_over_y = is_longer(d[0], d[1]), x_over_z = is_longer(d[0], d[2]),
                   y_over_z = is_longer(d[1], d[2]);
    if ((x_over_y & x_over_z) == 0xffff) return 0;
    if (x_over_y == 0 && y_over_z == 0xffff) return 1;
    return ((x_over_y & x_over_z) | (~x_over_y & y_over_z & 0xffff)) == 0 ? 2 : 3;
}

/// About the middle of the rays.
RELIEF_INLINE Vec3f find_forward(const Affine& from_origin, const BundleRays& rays) {
    const auto direction = [&](uint32_t k) {
        return normalize(transform_vector(from_origin, rays.direction_of(k)));
    };
    const uint32_t last = rays.count - 1;
    return normalize(direction(0) + direction(last / 3) + direction(last - last / 3) + direction(last));
}

/// Takes the major axis of the first sixteen rays for all; false where these have several.
RELIEF_INLINE bool choose_major_axis(const Affine& from_origin, RayBundle& bundle) {
    static constexpr int kMinorAxes[4][2] = {{1, 2}, {2, 0}, {0, 1}, {0, 0}};
    Lanes16 d[3];
    transform_directions(*bundle.rays, from_origin, 0, d);
    const int major = find_major_axis(d);
    bundle.axis[0] = kMinorAxes[major][0], bundle.axis[1] = kMinorAxes[major][1];
    bundle.axis[2] = major;
    return major != 3;
}

/// Test data and dz_dt of sixteen rays. False for rays backwards or along another axis than bundle.axis[2].
RELIEF_INLINE bool store_directions(const Lanes16 (&d)[3], size_t at, RayBundle& bundle, Lanes16& rcp_dz_dt) {
    if (find_major_axis(d) != bundle.axis[2]) return false;
    const Lanes16 dz_dt = dot_lanes(d, bundle.forward);
    const Lanes16 squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    // Squares of other speeds might vanish, or be infinite, and tell nothing.
    if ((less(Lanes16(1e-15f), dz_dt) & less(dz_dt, Lanes16(1e15f)) &
         less_equal(squared * Lanes16(0.25f), dz_dt * dz_dt)) != 0xffff)
        return false;
    rcp_dz_dt = Lanes16(1.0f) / dz_dt;
    const Lanes16 inverse = Lanes16(1.0f) / d[bundle.axis[2]];
    dz_dt.store(bundle.dz_dt + at);
    (d[bundle.axis[0]] * inverse).store(bundle.shear[0] + at);
    (d[bundle.axis[1]] * inverse).store(bundle.shear[1] + at);
    inverse.store(bundle.shear[2] + at);
    return true;
}

/// The range of a group on the plane.
RELIEF_INLINE void store_range(const Lanes16& x, const Lanes16& y, uint32_t group, RayBundle& bundle) {
    const size_t at = group * kGroupSize;
    x.store(bundle.x + at), y.store(bundle.y + at);
    bundle.lower_x[group] = reduce_min(x), bundle.upper_x[group] = reduce_max(x);
    bundle.lower_y[group] = reduce_min(y), bundle.upper_y[group] = reduce_max(y);
}

/// The groups of rays that may be inside. find_ranges(bundle, bounds, get) gives where groups are at the
/// depth of bounds, find_places where rays are; get(array) takes those that are meant out of an array.
template <class Bundle>
RELIEF_INLINE LaneMask find_groups(const ProjectedBounds& bounds, const Bundle& bundle) {
    const ProjectedLanes<16> of_all = spread<16>(bounds);
    const auto get = [](const float* of_groups) { return Lanes16::load(of_groups); };
    return find_ranges(bundle, of_all, get).overlap(of_all);
}

/// The parts that any ray of a group may meet; of all groups: kGroupCount.
template <size_t W, class Bundle>
RELIEF_INLINE LaneMask find_parts_of_group(const ProjectedLanes<W>& part, const Bundle& bundle,
                                           uint32_t group) {
    const auto get = [&](const float* of_groups) { return Lanes<W>(of_groups[group]); };
    return find_ranges(bundle, part, get).overlap(part);
}

/// The parts that one ray may meet.
template <class Bundle>
RELIEF_INLINE LaneMask find_parts_of_ray(const PartBounds& part, const Bundle& bundle, uint32_t ray) {
    const auto get = [&](const float* of_rays) { return Lanes8(of_rays[ray]); };
    return find_places(bundle, part, get).overlap(part);
}

/// The greatest value of dot(p, n) over W boxes (lower x y z, upper x y z).
template <size_t W> RELIEF_INLINE Lanes<W> find_greatest(const Lanes<W> (&bound)[6], const Vec3f& n) {
    const float factor[3] = {n.x, n.y, n.z};
    Lanes<W> sum(0.0f);
    for (int k = 0; k < 3; ++k) sum = sum + bound[factor[k] < 0 ? k : 3 + k] * Lanes<W>(factor[k]);
    return sum;
}

/// W boxes as all kinds of rays see them.
template <size_t W> struct RelativeBoxes {
    Lanes<W> bound[6], reach; ///< from the bundle's origin; the greatest distance along an axis

    RELIEF_INLINE RelativeBoxes(const Lanes<W> (&bounds)[6], const Vec3f& from) : reach(0.0f) {
        const float origin[3] = {from.x, from.y, from.z};
        for (int k = 0; k < 6; ++k) {
            bound[k] = bounds[k] - Lanes<W>(origin[k % 3]);
            reach = max(reach, max(bound[k], Lanes<W>(0.0f) - bound[k]));
        }
    }
};

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
