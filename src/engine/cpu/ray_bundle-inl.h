// Many rays from one point, in the space of one object: a pinhole camera's, or those of a point light. Seen
// from there everything lies on a plane, so that boxes and blocks are tested once for all rays against
// windows of that plane, and each ray meets only the blocks whose window it lies in.
//
// Windows are wider than rounding asks for; what decides a hit is the test of ray_state-inl.h, operation for
// operation, so that a ray's hit does not depend on its company.
#if defined(RELIEF_RAY_BUNDLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RAY_BUNDLE_INL_H
#undef RELIEF_RAY_BUNDLE_INL_H
#else
#define RELIEF_RAY_BUNDLE_INL_H
#endif

#include <algorithm>
#include <cstddef>

#include "engine/cpu/bottom_build-inl.h"
#include "engine/cpu/camera_rays-inl.h"
#include "engine/cpu/ray_lanes-inl.h"
#include "engine/cpu/ray_state-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

inline constexpr uint32_t kBundleSize = 256, kGroupSize = 16, kGroupCount = kBundleSize / kGroupSize;

/// Some sixty roundings of a place on the plane at distance 1, for rays that lie within 1 of the middle; what
/// lies farther aside than that is rounded in proportion.
inline constexpr float kWindowMargin = 4e-6f;
/// The same for the place of a box beside a plane, of the greatest distance of the box along an axis.
inline constexpr float kBoxMargin = 2e-6f;
inline constexpr float kDepthSlack = 1 - 2e-5f;
/// Beyond this, on the plane, a point is so far aside that its depth may have lost its sign to rounding.
inline constexpr float kWidestWindow = 1e4f;

struct HitLog;

/// What a ray may have found instead of a hit of the log: nothing, or what lies in its place already.
inline constexpr uint32_t kWritten = 0xfffffffe, kNothing = 0xffffffff;

/// What the spaces of all objects share: the rays, and what they met so far.
struct BundleRays {
    cpu::TraceHit* hits; ///< those of rays with kWritten are there
    HitLog* log;
    uint32_t count, bias;
    Vec3f origin;
    alignas(64) uint32_t found[kBundleSize]; ///< number in the log, kWritten or kNothing
    alignas(64) float t[kBundleSize];        ///< of the nearest hit, or the ray's t_max
    alignas(64) float t_min[kBundleSize];
    alignas(64) float direction[3][kBundleSize];

    Vec3f direction_of(uint32_t k) const { return {direction[0][k], direction[1][k], direction[2][k]}; }
    LaneMask group_mask(uint32_t group) const {
        const uint32_t first = group * kGroupSize;
        return count >= first + kGroupSize ? 0xffffu : count > first ? (1u << (count - first)) - 1 : 0u;
    }
};

/// Which of sixteen rays, repeated where there are fewer, can be in one bundle with `first`: can_hit, its
/// origin and its bias. Writes what the bundle keeps of them.
HWY_INLINE LaneMask load_group(const cpu::TraceRay* world, uint32_t count, const cpu::TraceRay& first,
                               size_t at, BundleRays& rays) {
    const RayLanes lanes(world, count, first.bias);
    LaneMask fits = lanes.of_bias & lanes.can_hit();
    const float origin[3] = {first.origin.x, first.origin.y, first.origin.z};
    for (int k = 0; k < 3; ++k) {
        fits &= equal(lanes.origin[k], Lanes16(origin[k]));
        lanes.direction[k].store(rays.direction[k] + at);
    }
    lanes.t_min.store(rays.t_min + at), lanes.t_max.store(rays.t + at);
    return fits;
}

/// Takes the rays at the front that leave one point together, at most kBundleSize.
inline void load_rays(const cpu::TraceRay* world, size_t count, BundleRays& rays) {
    rays.count = 0, rays.bias = world[0].bias, rays.origin = world[0].origin;
    const uint32_t most = uint32_t(HWY_MIN(count, size_t(kBundleSize)));
    while (rays.count < most) {
        const uint32_t left = HWY_MIN(most - rays.count, kGroupSize);
        const LaneMask fits = load_group(world + rays.count, left, world[0], rays.count, rays);
        const uint32_t taken = hwy::Num0BitsBelowLS1Bit_Nonzero32(~fits);
        rays.count += taken;
        if (taken < kGroupSize) break;
    }
}

/// Aims the rays of a pinhole camera through up to kBundleSize positions in the picture, and writes them to
/// `written` unless it is null.
inline void load_rays(const scalar::CameraFrame& camera, const Vec2f* positions, uint32_t count,
                      cpu::TraceRay* written, BundleRays& rays) {
    const WideCamera wide_camera(camera);
    const Lanes16 start(0.0f), end(std::numeric_limits<float>::infinity());
    rays.count = count, rays.bias = 0, rays.origin = camera.origin;
    for (uint32_t at = 0; at < count; at += kGroupSize) {
        const uint32_t size = HWY_MIN(count - at, kGroupSize);
        const wide::Vec3 direction = wide_camera.aim(positions + at, size);
        direction.x.store(rays.direction[0] + at), direction.y.store(rays.direction[1] + at);
        direction.z.store(rays.direction[2] + at);
        start.store(rays.t_min + at), end.store(rays.t + at);
        if (written) store_rays(camera.origin, direction, size, written + at);
    }
}

/// Places behind the last ray repeat it and reach nothing.
inline void fill_rest(BundleRays& rays) {
    for (uint32_t last = rays.count - 1, k = rays.count; k < kBundleSize; ++k) {
        rays.t[k] = 0, rays.t_min[k] = rays.t_min[last];
        for (float* direction : rays.direction) direction[k] = direction[last];
    }
}

/// A part of the plane, and the least depth of what is seen in it.
struct Window {
    float lower_x, upper_x, lower_y, upper_y, depth;
};

struct RayBundle {
    BundleRays* rays;
    Vec3f origin;
    Vec3f right, up, forward; ///< of the plane; orthonormal
    int axis[3];              ///< as in RayState; one choice for all rays
    Vec3f plane[4];           ///< normals of the sides of the pyramid that holds all rays, pointing inwards
    float farthest;           ///< depth of the farthest nearest hit
    uint32_t instance;
    alignas(64) float x[kBundleSize], y[kBundleSize]; ///< where a ray meets the plane
    alignas(64) float speed[kBundleSize];             ///< depth for a length of t
    alignas(64) float shear[3][kBundleSize];
    alignas(64) float lower_x[kGroupCount], upper_x[kGroupCount], lower_y[kGroupCount], upper_y[kGroupCount];
    alignas(64) float group_farthest[kGroupCount];
};

/// The farthest depth that a group still asks about, after hits.
HWY_INLINE float find_farthest(const RayBundle& bundle, uint32_t group) {
    const size_t at = group * kGroupSize;
    return reduce_max(Lanes16::load(bundle.rays->t + at) * Lanes16::load(bundle.speed + at));
}

HWY_INLINE void update_farthest(RayBundle& bundle) {
    bundle.farthest = reduce_max(Lanes16::load(bundle.group_farthest));
}

/// Depths of groups after hits.
HWY_INLINE void update_groups(RayBundle& bundle, LaneMask dirty) {
    if (!dirty) return;
    for (; dirty; dirty &= dirty - 1) {
        const uint32_t group = uint32_t(__builtin_ctz(dirty));
        bundle.group_farthest[group] = find_farthest(bundle, group);
    }
    update_farthest(bundle);
}

/// Directions of sixteen rays in an object's space, by the operations of transform_vector.
HWY_INLINE void transform_directions(const BundleRays& rays, const Affine& object_from_world, size_t at,
                                     Lanes16 (&d)[3]) {
    Lanes16 world[3];
    for (int k = 0; k < 3; ++k) world[k] = Lanes16::load(rays.direction[k] + at);
    for (size_t k = 0; k < 3; ++k) d[k] = dot_lanes(world, object_from_world.rows[k]);
}

/// A plane in front of the rays: about the middle of them, its axes along the rows that rays come in.
HWY_INLINE void choose_plane(const Affine& object_from_world, RayBundle& bundle) {
    const BundleRays& rays = *bundle.rays;
    const auto direction = [&](uint32_t k) {
        return normalize(transform_vector(object_from_world, rays.direction_of(k)));
    };
    const uint32_t last = rays.count - 1;
    bundle.forward =
        normalize(direction(0) + direction(last / 3) + direction(last - last / 3) + direction(last));
    const Vec3f along = direction(HWY_MIN(3u, last)) - direction(0);
    Vec3f right = along - bundle.forward * dot(along, bundle.forward);
    if (!(dot(right, right) > 0)) {
        const Vec3f& f = bundle.forward;
        right = std::fabs(f.x) > 0.5f ? Vec3f{-f.y, f.x, 0} : Vec3f{0, -f.z, f.y};
    }
    bundle.right = normalize(right);
    bundle.up = cross(bundle.forward, bundle.right);
}

/// Which lanes have |a| > |b|.
HWY_INLINE LaneMask is_longer(const Lanes16& a, const Lanes16& b) {
    const Lanes16 zero(0.0f);
    return less(max(b, zero - b), max(a, zero - a));
}

/// The major axis of sixteen directions by the choice of enter_object; 3 if they differ.
HWY_INLINE int find_major_axis(const Lanes16 (&d)[3]) {
    const LaneMask x_over_y = is_longer(d[0], d[1]), x_over_z = is_longer(d[0], d[2]),
                   y_over_z = is_longer(d[1], d[2]);
    if ((x_over_y & x_over_z) == 0xffff) return 0;
    if (x_over_y == 0 && y_over_z == 0xffff) return 1;
    return ((x_over_y & x_over_z) | (~x_over_y & y_over_z & 0xffff)) == 0 ? 2 : 3;
}

/// Sixteen rays; false where they do not go forward, or along another axis than bundle.axis[2].
HWY_INLINE bool enter_group(const Lanes16 (&d)[3], uint32_t group, RayBundle& bundle) {
    if (find_major_axis(d) != bundle.axis[2]) return false;
    const size_t at = group * kGroupSize;
    const Lanes16 speed = dot_lanes(d, bundle.forward);
    const Lanes16 squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if ((less(Lanes16(0.0f), speed) & less_equal(squared * Lanes16(0.25f), speed * speed)) != 0xffff)
        return false;
    const Lanes16 closeness = Lanes16(1.0f) / speed;
    const Lanes16 x = dot_lanes(d, bundle.right) * closeness, y = dot_lanes(d, bundle.up) * closeness;
    const Lanes16 inverse = Lanes16(1.0f) / d[bundle.axis[2]];
    x.store(bundle.x + at), y.store(bundle.y + at), speed.store(bundle.speed + at);
    (d[bundle.axis[0]] * inverse).store(bundle.shear[0] + at);
    (d[bundle.axis[1]] * inverse).store(bundle.shear[1] + at);
    inverse.store(bundle.shear[2] + at);
    bundle.lower_x[group] = reduce_min(x), bundle.upper_x[group] = reduce_max(x);
    bundle.lower_y[group] = reduce_min(y), bundle.upper_y[group] = reduce_max(y);
    bundle.group_farthest[group] = find_farthest(bundle, group);
    return true;
}

/// The sides of the pyramid about all rays, a margin outside of them.
HWY_INLINE void make_sides(RayBundle& bundle) {
    const float left = reduce_min(Lanes16::load(bundle.lower_x)) - 2 * kWindowMargin;
    const float right = reduce_max(Lanes16::load(bundle.upper_x)) + 2 * kWindowMargin;
    const float bottom = reduce_min(Lanes16::load(bundle.lower_y)) - 2 * kWindowMargin;
    const float top = reduce_max(Lanes16::load(bundle.upper_y)) + 2 * kWindowMargin;
    bundle.plane[0] = bundle.right - bundle.forward * left;
    bundle.plane[1] = bundle.forward * right - bundle.right;
    bundle.plane[2] = bundle.up - bundle.forward * bottom;
    bundle.plane[3] = bundle.forward * top - bundle.up;
}

/// Takes the rays into another space. False where they diverge too much there, or have different major axes.
HWY_INLINE bool enter_space(const Affine& object_from_world, RayBundle& bundle) {
    static constexpr int kMinorAxes[4][2] = {{1, 2}, {2, 0}, {0, 1}, {0, 0}};
    bundle.origin = transform_point(object_from_world, bundle.rays->origin);
    choose_plane(object_from_world, bundle);
    for (uint32_t group = 0; group < kGroupCount; ++group) {
        Lanes16 d[3];
        transform_directions(*bundle.rays, object_from_world, group * kGroupSize, d);
        if (group == 0) {
            const int major = find_major_axis(d);
            bundle.axis[0] = kMinorAxes[major][0], bundle.axis[1] = kMinorAxes[major][1];
            bundle.axis[2] = major;
        }
        if (bundle.axis[2] == 3 || !enter_group(d, group, bundle)) return false;
    }
    make_sides(bundle);
    update_farthest(bundle);
    return true;
}

/// The greatest value of dot(p, n) over W boxes (lower x y z, upper x y z).
template <size_t W> HWY_INLINE Lanes<W> find_greatest(const Lanes<W> (&bound)[6], const Vec3f& n) {
    const float factor[3] = {n.x, n.y, n.z};
    Lanes<W> sum(0.0f);
    for (int k = 0; k < 3; ++k) sum = sum + bound[factor[k] < 0 ? k : 3 + k] * Lanes<W>(factor[k]);
    return sum;
}

/// The boxes that reach into the pyramid, and the least depth of each.
template <size_t W>
HWY_INLINE LaneMask test_boxes(const Lanes<W> (&bound)[6], const RayBundle& bundle, Lanes<W>& nearest) {
    const float origin[3] = {bundle.origin.x, bundle.origin.y, bundle.origin.z};
    const Lanes<W> zero(0.0f);
    Lanes<W> relative[6], reach = zero;
    for (int k = 0; k < 6; ++k) {
        relative[k] = bound[k] - Lanes<W>(origin[k % 3]);
        reach = max(reach, max(relative[k], zero - relative[k]));
    }
    const Lanes<W> margin = reach * Lanes<W>(kBoxMargin), least = zero - margin;
    nearest = least - find_greatest(relative, -bundle.forward);
    LaneMask mask = less_equal(nearest * Lanes<W>(kDepthSlack), Lanes<W>(bundle.farthest)) &
                    less_equal(least, find_greatest(relative, bundle.forward));
    for (const Vec3f& side : bundle.plane) mask &= less_equal(least, find_greatest(relative, side));
    return mask;
}

/// The window in which points are seen; `v` is relative to the origin of the rays.
template <size_t W> HWY_INLINE Window find_window(const Lanes<W> (&v)[3], const RayBundle& bundle) {
    const Lanes<W> depth = dot_lanes(v, bundle.forward), inverse = Lanes<W>(1.0f) / depth;
    const Lanes<W> x = dot_lanes(v, bundle.right) * inverse, y = dot_lanes(v, bundle.up) * inverse;
    const float least = reduce_min(depth);
    Window window = {reduce_min(x), reduce_max(x), reduce_min(y), reduce_max(y), least};
    const bool is_in_front = least > 0 && window.lower_x > -kWidestWindow && window.upper_x < kWidestWindow &&
                             window.lower_y > -kWidestWindow && window.upper_y < kWidestWindow;
    if (!is_in_front) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        return {-kEnd, kEnd, -kEnd, kEnd, -kEnd};
    }
    const float aside =
        HWY_MAX(HWY_MAX(-window.lower_x, window.upper_x), HWY_MAX(-window.lower_y, window.upper_y));
    const float margin = kWindowMargin * HWY_MAX(1.0f, aside);
    window.lower_x -= margin, window.upper_x += margin, window.lower_y -= margin, window.upper_y += margin;
    window.depth *= kDepthSlack - margin;
    return window;
}

/// The groups of rays that a window may concern.
HWY_INLINE LaneMask find_groups(const Window& window, const RayBundle& bundle) {
    return less_equal(Lanes16(window.lower_x), Lanes16::load(bundle.upper_x)) &
           less_equal(Lanes16::load(bundle.lower_x), Lanes16(window.upper_x)) &
           less_equal(Lanes16(window.lower_y), Lanes16::load(bundle.upper_y)) &
           less_equal(Lanes16::load(bundle.lower_y), Lanes16(window.upper_y)) &
           less_equal(Lanes16(window.depth), Lanes16::load(bundle.group_farthest));
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
