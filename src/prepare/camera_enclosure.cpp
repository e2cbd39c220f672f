#include "prepare/camera_enclosure.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

#include "base/parallel.h"
#include "math/affine.h"
#include "surface/map/displacement_map.h"

namespace relief {

namespace {

/// Of a closed surface the winding number is an integer. Open ones that surround the camera this far count.
constexpr double kLeastWinding = 0.9;
constexpr size_t kPatchesAtOnce = 4096;

/// A surface, and how far around its base all of it lies, object space.
struct Body {
    const Surface* surface = nullptr;
    Box base_box;
    float margin = 0;
};

Box widen(const Box& box, float by) {
    const Vec3f around{by, by, by};
    return {box.lower - around, box.upper + around};
}

Body make_body(const Surface& surface) {
    Body body{&surface, {}, float(find_longest_displacement(surface.map) * double(surface.map.longest_axis))};
    for (const Vec3f& p : surface.positions) body.base_box.extend(p);
    for (const InnerControls& controls : surface.controls)
        for (const Vec3f& p : controls) body.base_box.extend(p);
    // With relative lengths, displacements are multiples of the derivatives.
    float longest = 1;
    for (const auto& [dp_du, dp_dv] : surface.derivatives)
        longest = std::max({longest, length(dp_du), length(dp_dv)});
    body.margin *= longest * std::sqrt(3.0f);
    return body;
}

Box compute_base_box(const Surface& surface, uint32_t patch) {
    Box box;
    for (const uint32_t vertex : surface.quads[patch].vertex) box.extend(surface.position(vertex));
    if (!surface.controls.empty())
        for (const Vec3f& p : surface.controls[patch]) box.extend(p);
    return box;
}

/// Of a triangle as seen from the origin (van Oosterom and Strackee 1983, equation 8), signed.
double compute_solid_angle(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const float la = length(a), lb = length(b), lc = length(c);
    const float divisor = la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la;
    return 2 * std::atan2(double(dot(a, cross(b, c))), double(divisor));
}

double compute_solid_angle(const Surface& surface, uint32_t patch, const Vec3f& from) {
    Vec3f corner[4];
    const Quad quad = surface.quads[patch];
    for (size_t k = 0; k < 4; ++k) corner[k] = surface.position(quad.vertex[k]) - from;
    return compute_solid_angle(corner[0], corner[1], corner[2]) +
           compute_solid_angle(corner[0], corner[2], corner[3]);
}

/// The absolute winding number about a place in object space, infinite where it is less than `around` away
/// from a patch's box.
double find_winding(const Body& body, const Vec3f& place, float around) {
    const Surface& surface = *body.surface;
    if (!widen(body.base_box, body.margin + around).contains(place)) return 0;
    std::vector<double> angles((surface.patch_count() + kPatchesAtOnce - 1) / kPatchesAtOnce);
    std::atomic<bool> is_near = false;
    parallel_for("camera_enclosure", angles.size(), 1, [&](size_t begin, size_t end) {
        const auto last = uint32_t(std::min<size_t>(end * kPatchesAtOnce, surface.patch_count()));
        for (auto patch = uint32_t(begin * kPatchesAtOnce); patch < last && !is_near; ++patch) {
            angles[patch / kPatchesAtOnce] += compute_solid_angle(surface, patch, place);
            if (widen(compute_base_box(surface, patch), body.margin + around).contains(place) &&
                widen(compute_patch_box(surface, patch), around).contains(place))
                is_near = true;
        }
    });
    if (is_near) return INFINITY;
    double sum = 0;
    for (const double angle : angles) sum += angle;
    return std::fabs(sum) / (4 * std::numbers::pi);
}

} // namespace

bool may_enclose_camera(const PreparedScene& scene) {
    std::map<uint32_t, Body> bodies;
    double winding = 0;
    for (const Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        const float aperture = scene.camera.aperture_radius;
        const float distance = length(scene.camera.from - instance.world_from_object.translation);
        if (!surface.has_displacement || distance - aperture > instance.reach) continue;
        const auto [found, is_new] = bodies.try_emplace(instance.surface);
        if (is_new) found->second = make_body(surface);
        const Vec3f place = instance.object_space.place(scene.camera.from);
        winding += find_winding(found->second, place,
                                aperture * float(bound_scale(instance.object_space.from_origin)));
        if (winding > kLeastWinding) return true;
    }
    return false;
}

} // namespace relief
