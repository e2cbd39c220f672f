// aim_scene and turn_camera.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "io/scene/frame_scene.h"
#include "io/scene/studio.h"
#include "math/vec.h"
#include "relief/aim.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr float kRadians = std::numbers::pi_v<float> / 180;

void require_objects(const Scene& scene) {
    if (scene.objects.empty())
        throw Error(ErrorKind::usage, {"the scene has no objects to frame", scene.source,
                                       "give a position of the camera: from, to"});
}

/// `zoom` times as large: the camera stays, its angle becomes another.
void zoom_camera(Camera& camera, float zoom) {
    constexpr float kWidest = 179;
    const float tangent = std::tan(camera.fov_degrees * kRadians / 2) / zoom;
    const float fov = 2 * std::atan(tangent) / kRadians;
    if (!(zoom > 0 && fov > 0 && fov <= kWidest))
        throw Error(ErrorKind::usage,
                    {fmt::format("zoom {} of a camera of {:.4g} degrees makes one of {:.4g}", zoom,
                                 camera.fov_degrees, fov),
                     "", fmt::format("its angle may be up to {}", kWidest)});
    camera.fov_degrees = fov;
}

void place_camera(Scene& scene, const AimOptions& options, float aspect) {
    if (options.from && (options.view || options.frame_all))
        throw Error(ErrorKind::usage, {"the camera has one place: from, or one that frames all objects",
                                       scene.source, "leave out from, or view and frame-all"});
    Camera camera = scene.camera;
    if (options.fov_degrees) camera.fov_degrees = *options.fov_degrees;
    if (options.view || options.frame_all) {
        require_objects(scene);
        const Vec3f back = camera.from - camera.to;
        const Vec3f view = options.view       ? choose_view(scene, *options.view)
                           : length(back) > 0 ? normalize(back)
                                              : choose_view(scene, View::automatic);
        if (options.view) camera.up = {0, 1, 0};
        camera =
            frame_scene(scene, camera, view, aspect, options.is_turntable ? Framing::turn : Framing::still);
    }
    if (!options.from && !options.to) {
        scene.camera = camera;
        return;
    }
    if (options.from) camera.from = *options.from;
    if (options.to) {
        camera.to = *options.to;
    } else {
        require_objects(scene);
        camera.to = measure_scene(scene).center();
    }
    const float distance = length(camera.to - camera.from);
    if (!(distance > 0))
        throw Error(ErrorKind::usage,
                    {"the camera would look at its own position",
                     fmt::format("from {},{},{}", camera.from.x, camera.from.y, camera.from.z),
                     "from and to must differ"});
    camera.focus_distance = distance;
    if (length(cross(camera.up, camera.to - camera.from)) <= 1e-6f * distance) camera.up = {0, 0, -1};
    scene.camera = camera;
}

void aim_camera(Scene& scene, const AimOptions& options, float aspect) {
    place_camera(scene, options, aspect);
    if (options.zoom) zoom_camera(scene.camera, *options.zoom);
}

void aim_environment(Scene& scene, const AimOptions& options) {
    if (!options.rotate_degrees && !options.strength) return;
    if (!scene.environment)
        throw Error(ErrorKind::usage, {"the scene has no environment to turn or to scale", scene.source,
                                       "its file says it under 'environment'"});
    if (options.rotate_degrees) scene.environment->rotate_degrees = *options.rotate_degrees;
    if (options.strength) scene.environment->strength = *options.strength;
}

void replace_suns(Scene& scene, const std::vector<SunDirection>& suns) {
    if (suns.empty()) return;
    Light sun;
    sun.angle_degrees = 3, sun.color = {1.0f, 0.95f, 0.88f}, sun.strength = 2.2f;
    const auto is_sun = [](const Light& light) { return light.type == LightType::sun; };
    if (const auto found = std::ranges::find_if(scene.lights, is_sun); found != scene.lights.end())
        sun = *found; // keeps its colour and strength
    std::erase_if(scene.lights, is_sun);
    for (const SunDirection& direction : suns) {
        const float azimuth = direction.azimuth * kRadians, elevation = direction.elevation * kRadians;
        sun.direction = Vec3f{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                              std::cos(azimuth) * std::cos(elevation)} *
                        -1.0f;
        scene.lights.push_back(sun);
    }
}

/// "ground", or with a number where something is called so.
template <class Named> std::string name_ground(const std::vector<Named>& others) {
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::any_of(others, [&](const Named& other) { return other.name == name; });
    };
    std::string name = "ground";
    for (int k = 2; is_taken(name); ++k) name = fmt::format("ground-{}", k);
    return name;
}

/// A quad under the lowest point, whose rim looks near to the horizon. In the studio it is of the colour of
/// the backdrop there.
void add_ground(Scene& scene, Ground ground) {
    require_objects(scene);
    const Box box = measure_scene(scene);
    const Vec3f size = box.extent(), middle = box.center();
    const float radius = 20 * std::max({size.x, size.y, size.z, length(scene.camera.from - middle)});
    const float below = 1e-4f * std::max({size.x, size.y, size.z}); // samples may miss the lowest point
    Mesh plane;
    plane.name = name_ground(scene.meshes);
    for (const auto& [x, z] : {std::pair{-1, 1}, {1, 1}, {1, -1}, {-1, -1}})
        plane.positions.push_back(
            {middle.x + float(x) * radius, box.lower.y - below, middle.z + float(z) * radius});
    plane.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    plane.face_sizes = {4};
    plane.position_indices = plane.uv_indices = {0, 1, 2, 3};
    Material material;
    material.name = name_ground(scene.materials);
    material.base_color = {0.5f, 0.5f, 0.5f}, material.roughness = 0.8f;
    if (const std::optional<Vec3f> color = match_floor(scene); color && ground == Ground::plane)
        material.base_color = *color, material.ior = 1; // reflections would show its rim
    Object object;
    object.name = name_ground(scene.objects);
    object.mesh = uint32_t(scene.meshes.size()), object.material = uint32_t(scene.materials.size());
    object.is_shadow_catcher = ground == Ground::shadow;
    scene.meshes.push_back(std::move(plane));
    scene.materials.push_back(std::move(material));
    scene.objects.push_back(std::move(object));
}

/// What the options left in the scene.
uint64_t hash_aimed(const Scene& scene, Ground ground) {
    ContentHash hash(scene.hash);
    const auto add = [&](const Vec3f& v) { hash.add(fmt::format("{} {} {};", v.x, v.y, v.z)); };
    const Camera& camera = scene.camera;
    add(camera.from), add(camera.to), add(camera.up);
    add({camera.fov_degrees, camera.aperture_radius, camera.focus_distance});
    if (camera.shift != Vec2f{}) add({camera.shift.x, camera.shift.y, 0});
    if (scene.environment) add({scene.environment->strength, scene.environment->rotate_degrees, 0});
    for (const Light& light : scene.lights) add(light.direction);
    if (ground != Ground::none) hash.add("ground");
    if (ground == Ground::shadow) hash.add("shadow");
    return hash.value();
}

} // namespace

void aim_scene(Scene& scene, const AimOptions& options, float aspect) {
    const bool is_changed = options.from || options.to || options.fov_degrees || options.zoom ||
                            options.view || options.frame_all || options.rotate_degrees || options.strength ||
                            !options.suns.empty() || options.ground != Ground::none;
    if (!is_changed) return;
    validate_scene(scene); // framing follows the indices of the meshes and the uvs into the maps
    const Camera before = scene.camera;
    aim_camera(scene, options, aspect);
    turn_studio(scene, before);
    aim_environment(scene, options);
    replace_suns(scene, options.suns);
    if (options.ground != Ground::none) add_ground(scene, options.ground);
    validate_scene(scene);
    if (scene.hash != 0) scene.hash = hash_aimed(scene, options.ground);
}

Camera turn_camera(const Camera& camera, float degrees) {
    const Vec3f axis = normalize(camera.up), arm = camera.from - camera.to;
    const float cosine = std::cos(degrees * kRadians), sine = std::sin(degrees * kRadians);
    Camera turned = camera;
    // Rodrigues' rotation
    turned.from = camera.to + arm * cosine + cross(axis, arm) * sine + axis * (dot(axis, arm) * (1 - cosine));
    return turned;
}

} // namespace relief
