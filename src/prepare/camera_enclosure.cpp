#include "prepare/camera_enclosure.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <numeric>
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

using Point = std::array<double, 3>;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double find_length(const Point& a) { return std::hypot(a[0], a[1], a[2]); }

/// Of a triangle as seen from the origin (van Oosterom and Strackee 1983, equation 8), signed.
double compute_solid_angle(const Point& a, const Point& b, const Point& c) {
    const Point normal = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
    const double la = find_length(a), lb = find_length(b), lc = find_length(c);
    return 2 * std::atan2(dot(a, normal), la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
}

double compute_solid_angle(const Surface& surface, uint32_t patch, const Vec3f& from) {
    Point corner[4];
    const Quad quad = surface.quads[patch];
    for (size_t k = 0; k < 4; ++k) {
        const Vec3f& p = surface.position(quad.vertex[k]);
        corner[k] = {double(p.x) - double(from.x), double(p.y) - double(from.y),
                     double(p.z) - double(from.z)};
    }
    return compute_solid_angle(corner[0], corner[1], corner[2]) +
           compute_solid_angle(corner[0], corner[2], corner[3]);
}

/// The pieces of a surface that hang together, as one of their vertices each.
class Pieces {
  public:
    explicit Pieces(const Surface& surface) : parent_(surface.positions.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        for (const Quad& quad : surface.quads)
            for (size_t k = 1; k < 4; ++k)
                parent_[find(surface.dominant(quad.vertex[k]))] = find(surface.dominant(quad.vertex[0]));
    }
    uint32_t find(uint32_t vertex) {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }

  private:
    std::vector<uint32_t> parent_;
};

/// Solid angles of the patches as seen from a place in object space; empty where that is less than `around`
/// away from a patch's box.
std::vector<double> compute_solid_angles(const Body& body, const Vec3f& place, float around) {
    const Surface& surface = *body.surface;
    std::vector<double> angles(surface.patch_count());
    std::atomic<bool> is_near = false;
    parallel_for("camera_enclosure", angles.size(), kPatchesAtOnce, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end && !is_near; ++k) {
            const auto patch = uint32_t(k);
            angles[k] = compute_solid_angle(surface, patch, place);
            if (widen(compute_base_box(surface, patch), body.margin + around).contains(place) &&
                widen(compute_patch_box(surface, patch), around).contains(place))
                is_near = true;
        }
    });
    if (is_near) angles.clear();
    return angles;
}

/// The greater of two numbers: the winding number of all of the surface about a place, and the greatest of
/// one of its pieces, as those of two walls of one body cancel. Infinite near the surface.
double find_winding(const Body& body, const Vec3f& place, float around) {
    if (!widen(body.base_box, body.margin + around).contains(place)) return 0;
    const std::vector<double> angles = compute_solid_angles(body, place, around);
    if (angles.empty()) return INFINITY;
    Pieces pieces(*body.surface);
    std::map<uint32_t, double> of_piece;
    double sum = 0;
    for (uint32_t patch = 0; patch < angles.size(); ++patch) {
        sum += angles[patch];
        of_piece[pieces.find(body.surface->dominant(body.surface->quads[patch].vertex[0]))] += angles[patch];
    }
    double most = std::fabs(sum);
    for (const auto& [piece, angle] : of_piece) most = std::max(most, std::fabs(angle));
    return most / (4 * std::numbers::pi);
}

} // namespace

bool may_enclose_camera(const PreparedScene& scene) {
    if (scene.levels.fixed_level >= 0) return false; // all rays see one surface
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
