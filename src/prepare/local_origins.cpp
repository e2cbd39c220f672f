#include "prepare/local_origins.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "formulas/local_start.h"
#include "math/vec.h"
#include "surface/map/displacement_map.h"

namespace relief {

namespace {

/// Sizes of an object or mesh from the origin of its space, beyond which it gets one of its own. Nearer ones
/// keep 14 of 24 bits and more through the sums of a transform: a quarter of a pixel where they fill a
/// picture 4096 wide.
constexpr double kFar = 1024;

/// The same beyond which pictures are taken relative to the camera: rays that start on an object are moved
/// off it by some 2^-18 of how far from the origin it lies (scalar::bound_position_error), here 1/32 of its
/// size.
constexpr double kFarForShadows = 8192;

using Point = std::array<double, 3>;

Point to_point(const Vec3f& v) { return {v.x, v.y, v.z}; }
Vec3f to_floats(const Point& p) { return {float(p[0]), float(p[1]), float(p[2])}; }

Point add(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point subtract(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double find_length(const Point& v) { return std::hypot(v[0], v[1], v[2]); }
double find_length(const Vec3f& v) { return find_length(to_point(v)); }

Point transform_vector(const Affine& m, const Point& v) {
    Point result;
    for (size_t k = 0; k < 3; ++k) {
        const Point row = to_point(m.rows[k]);
        result[k] = row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
    }
    return result;
}

/// The middle of an interval where nothing rounds that has it taken off (Sterbenz 1974), else 0.
float choose_middle(float lower, float upper) {
    const float middle = 0.5f * lower + 0.5f * upper;
    const float least = std::fmin(std::fabs(lower), std::fabs(upper));
    const float greatest = std::fmax(std::fabs(lower), std::fabs(upper));
    const bool is_exact =
        (lower > 0) == (upper > 0) && std::fabs(middle) <= 2 * least && greatest <= 2 * std::fabs(middle);
    return is_exact ? middle : 0.0f;
}

/// Greatest distance of the base from the object's origin, of what is within its points.
double find_base_reach(const Surface& surface) {
    double reach = 0;
    for (const Vec3f& p : surface.positions) reach = std::max(reach, find_length(p));
    for (const InnerControls& controls : surface.controls)
        for (const Vec3f& p : controls) reach = std::max(reach, find_length(p));
    return reach;
}

/// A power of two, so that few edits of a map change it.
float round_up(double reach) { return float(std::exp2(std::ceil(std::log2(std::max(reach, 1e-30))))); }

float find_reach(const Surface& surface, double base_reach, const Affine& world_from_object) {
    return round_up((base_reach + find_longest_displacement(surface.map)) * bound_scale(world_from_object));
}

/// Where the origin of an object whose mesh had `taken_off` taken off lies, world space.
Point find_place(const Affine& world_from_object, const Vec3f& taken_off) {
    return add(to_point(world_from_object.translation),
               transform_vector(world_from_object, to_point(taken_off)));
}

/// Whether an object would cast its shadows on itself from places too coarse.
bool is_far_away(const Point& place, double reach) { return find_length(place) > kFarForShadows * reach; }

/// Such an object, which would not as seen from the camera.
bool is_better_seen_from(const Vec3f& camera, const Point& place, double reach) {
    return is_far_away(place, reach) &&
           2 * find_length(subtract(place, to_point(camera))) < find_length(place);
}

void move_world(Vec3f origin, PreparedScene& scene) {
    scene.origin = origin;
    scene.camera.from = scene.camera.from - origin, scene.camera.to = scene.camera.to - origin;
    for (Light& light : scene.lights) light.position = light.position - origin;
}

/// `place`: of the object's origin; `reach`: of its base, world space.
void place_instance(const Affine& world_from_object, const Point& place, double reach, Instance& instance) {
    instance.world_from_object = world_from_object;
    instance.object_space = {{}, *invert(world_from_object)};
    instance.is_mirrored = compute_determinant(world_from_object) < 0;
    Affine& from_origin = instance.object_space.from_origin;
    const Vec3f rounded = to_floats(place);
    const bool is_far = find_length(place) > kFar * reach;
    if (is_far) instance.object_space.origin = rounded;
    if (is_far || place != to_point(world_from_object.translation)) {
        instance.world_from_object.translation = rounded;
        const Point left = subtract(place, to_point(instance.object_space.origin));
        from_origin.translation = to_floats(subtract({}, transform_vector(from_origin, left)));
    }
    instance.is_in_place = from_origin == Affine{} && instance.world_from_object == Affine{};
}

/// Whether rays of the scene may start so far away that they are moved before they meet an object of this
/// reach.
bool may_be_far_away(const PreparedScene& scene, const Vec3f& center, float reach) {
    const auto is_far = [&](const Vec3f& place, float around) {
        return length(place - center) + around > scalar::kFarAway * reach;
    };
    return is_far(scene.camera.from, 0) || std::ranges::any_of(scene.instances, [&](const Instance& other) {
               return is_far(other.world_from_object.translation, other.reach);
           });
}

} // namespace

std::vector<Vec3f> move_meshes_to_origin(Scene& scene, std::span<const uint8_t> is_kept) {
    std::vector<Vec3f> taken_off(scene.meshes.size());
    parallel_for("move_meshes_to_origin", scene.meshes.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            if (is_kept[k]) continue;
            Box box;
            for (const Vec3f& p : scene.meshes[k].positions) box.extend(p);
            if (box.is_empty() || !(find_length(box.center()) > kFar * find_length(box.extent()))) continue;
            taken_off[k] = {choose_middle(box.lower.x, box.upper.x), choose_middle(box.lower.y, box.upper.y),
                            choose_middle(box.lower.z, box.upper.z)};
            for (Vec3f& p : scene.meshes[k].positions) p = p - taken_off[k];
        }
    });
    return taken_off;
}

void place_instances(const Scene& scene, std::span<const Vec3f> taken_off, SceneOrigin origin,
                     PreparedScene& prepared) {
    std::vector<double> reaches;
    for (const Surface& surface : prepared.surfaces) reaches.push_back(find_base_reach(surface));
    std::vector<Point> places;
    bool is_camera_better = false;
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const Object& object = scene.objects[k];
        Instance& instance = prepared.instances[k];
        places.push_back(find_place(object.world_from_object, taken_off[object.mesh]));
        const double reach = reaches[instance.surface];
        instance.reach = find_reach(prepared.surfaces[instance.surface], reach, object.world_from_object);
        const double world_reach = reach * bound_scale(object.world_from_object);
        prepared.has_far_objects |= is_far_away(places.back(), world_reach);
        is_camera_better |= is_better_seen_from(prepared.camera.from, places.back(), world_reach);
    }
    if (origin == SceneOrigin::camera && is_camera_better) move_world(prepared.camera.from, prepared);
    if (origin == SceneOrigin::given && prepared.origin != Vec3f{}) move_world(prepared.origin, prepared);
    for (size_t k = 0; k < places.size(); ++k) {
        const Affine& world_from_object = scene.objects[k].world_from_object;
        Instance& instance = prepared.instances[k];
        place_instance(world_from_object, subtract(places[k], to_point(prepared.origin)),
                       reaches[instance.surface] * bound_scale(world_from_object), instance);
    }
}

bool update_reach(PreparedScene& scene, uint32_t surface) {
    const double base_reach = find_base_reach(scene.surfaces[surface]);
    bool is_changed = false;
    for (Instance& instance : scene.instances) {
        if (instance.surface != surface) continue;
        const float reach = find_reach(scene.surfaces[surface], base_reach, instance.world_from_object);
        // Near ones are met alike whatever their reach.
        is_changed |=
            reach != instance.reach &&
            may_be_far_away(scene, instance.world_from_object.translation, std::min(reach, instance.reach));
        instance.reach = reach;
    }
    return is_changed;
}

} // namespace relief
