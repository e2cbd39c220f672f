#include "samples/shot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/progress.h"
#include "math/affine.h"
#include "math/vec.h"
#include "samples/angles.h"
#include "samples/ocean.h"
#include "samples/stage.h"

namespace relief::samples {

namespace {

constexpr size_t kFrames = 24;
constexpr double kFramesPerSecond = 24;
constexpr int kTiles = 6;       // of the water along a side
constexpr int kCellsOfTile = 8; // quads along a side of a tile
constexpr float kCalm = -0.75f; // height of the far water, below all troughs
constexpr float kFarSize = 4000;

Vec3f turn(const Vec3f& p, float degrees) {
    return transform_vector(make_rotation_degrees({0, degrees, 0}), p);
}

/// A body of a profile from below to above, radius and height, turned about the y axis.
Mesh make_turned(const std::vector<Vec2f>& profile, uint32_t sides) {
    Mesh mesh;
    for (const Vec2f& point : profile)
        for (uint32_t k = 0; k < sides; ++k) {
            const float angle = 2 * kPi * float(k) / float(sides);
            mesh.positions.push_back({point.x * std::cos(angle), point.y, -point.x * std::sin(angle)});
        }
    for (uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (uint32_t k = 0; k < sides; ++k) {
            const uint32_t a = ring * sides + k, b = ring * sides + (k + 1) % sides;
            mesh.face_sizes.push_back(4);
            for (const uint32_t corner : {a, b, b + sides, a + sides})
                mesh.position_indices.push_back(corner);
        }
    return mesh;
}

Mesh make_box(const Vec3f& half, float degrees) {
    Mesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.positions.push_back(
            turn({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z}, degrees));
    mesh.face_sizes.assign(6, 4);
    mesh.position_indices = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    return mesh;
}

struct Body {
    const char* name;
    Vec2f place;  ///< x and z where the water is at rest
    float radius; ///< of the water that carries it
    float lift;   ///< of its origin above the water
    Vec3f color;
    float roughness;
};

constexpr std::array<Body, 5> kBodies = {
    {{"ring", {-1.7f, 2.6f}, 0.6f, 0.06f, {0.85f, 0.16f, 0.02f}, 0.4f},
     {"buoy", {1.5f, -0.6f}, 0.5f, 0.10f, {0.75f, 0.02f, 0.02f}, 0.35f},
     {"crate", {-2.9f, -2.4f}, 0.8f, 0.12f, {0.42f, 0.25f, 0.11f}, 0.8f},
     {"ball", {2.9f, 2.2f}, 0.35f, 0.10f, {0.9f, 0.75f, 0.08f}, 0.25f},
     {"marker", {7.0f, -14.0f}, 0.5f, 0.10f, {0.05f, 0.35f, 0.1f}, 0.35f}}};

Mesh make_body_mesh(const Body& body) {
    const std::string_view name = body.name;
    if (name == "ring") {
        TorusShape shape;
        shape.major_radius = 0.55f, shape.minor_radius = 0.16f;
        return make_torus(shape, [](const Vec3f& p) { return p; });
    }
    if (name == "crate") return make_box({0.62f, 0.42f, 0.5f}, 28);
    if (name == "ball") {
        Mesh mesh = make_icosphere(3, Shading::smooth);
        for (Vec3f& p : mesh.positions) p = p * 0.32f;
        return mesh;
    }
    return make_turned({{0.001f, -0.45f},
                        {0.36f, -0.40f},
                        {0.52f, -0.15f},
                        {0.52f, 0.05f},
                        {0.40f, 0.16f},
                        {0.16f, 0.26f},
                        {0.09f, 0.9f},
                        {0.20f, 0.95f},
                        {0.20f, 1.25f},
                        {0.001f, 1.33f}},
                       32);
}

Material make_material(const std::string& name, const Vec3f& color, float roughness) {
    Material material;
    material.name = name;
    material.base_color = color;
    material.roughness = roughness;
    return material;
}

Material make_water(const std::string& name, float roughness) {
    Material water = make_material(name, {0.006f, 0.035f, 0.045f}, roughness);
    water.ior = 1.333f;
    return water;
}

Ocean make_ocean() { return Ocean(Ocean::Config{}); }

double get_seconds(size_t frame_index) { return double(frame_index) / kFramesPerSecond; }

/// What floats goes with the water at one point of it, upright on the water around that.
SceneMotion::Placement float_body(const Body& body, const Ocean& ocean, const Texture& map) {
    const double tile = Ocean::Config{}.tile, middle = kTiles % 2 == 0 ? 0 : tile / 2;
    const auto find_water = [&](float dx, float dz) {
        const float x = body.place.x + dx, z = body.place.y + dz;
        return Vec3f{x, 0, z} + ocean.displace(map, double(x) + middle, double(z) + middle);
    };
    const float r = body.radius;
    const Vec3f across = find_water(r, 0) - find_water(-r, 0), along = find_water(0, r) - find_water(0, -r);
    const Vec3f up = normalize(cross(along, across));
    Vec3f place;
    for (const auto& [dx, dz] : {std::pair(0.0f, 0.0f), {r, 0.0f}, {-r, 0.0f}, {0.0f, r}, {0.0f, -r}})
        place += find_water(dx, dz) * 0.2f;
    constexpr float kDegrees = 180 / kPi;
    return {place + up * body.lift,
            {std::asin(up.z) * kDegrees, 0, std::atan2(-up.x, up.y) * kDegrees},
            {1, 1, 1}};
}

Affine make_transform(const SceneMotion::Placement& placement) {
    return compose(make_translation(placement.translate), make_rotation_degrees(placement.rotate_degrees));
}

/// Whole tiles around the origin, as many copies of the map.
Model make_water_model(const std::shared_ptr<const Texture>& map) {
    Model model;
    model.displacement.name = "ocean";
    model.displacement.space = DisplacementSpace::object;
    model.displacement.wrap = WrapMode::repeat;
    model.displacement.filter = MapFilter::bspline;
    model.displacement.tiles.push_back({1001, map});
    model.material = make_water("water", 0.05f);
    model.make_mesh = [](const Deformation& deform) {
        Mesh mesh = make_plane(float(Ocean::Config{}.tile) * kTiles / 2, kTiles * kCellsOfTile);
        for (Vec3f& p : mesh.positions) p = deform(p);
        for (Vec2f& uv : mesh.uvs) uv = uv * float(kTiles);
        return mesh;
    };
    return model;
}

constexpr Vec3f kFirstFrom{-1.6f, 1.9f, 9.5f}, kLastFrom{1.2f, 2.2f, 9.0f};
constexpr Vec3f kFirstTo{0.2f, 0.25f, 0}, kLastTo{0, 0.35f, 0};

} // namespace

Scene make_shot_scene(Instancing instancing, const ProgressFunction& on_progress) {
    ProgressCounter progress(on_progress, 1);
    const Ocean ocean = make_ocean();
    const std::shared_ptr<const Texture> map = ocean.make_map(0);
    Stage stage(instancing);
    stage.add_displaced(stage.add_model(make_water_model(map)), "water", Affine{},
                        [](const Vec3f& p) { return p; });
    for (const Body& body : kBodies)
        stage.add_plain(make_body_mesh(body), body.name, make_material(body.name, body.color, body.roughness),
                        make_transform(float_body(body, ocean, *map)));
    stage.add_plain(make_plane(kFarSize, 16), "far_water", make_water("far_water", 0.3f),
                    make_translation({0, kCalm, 0}));
    stage.light({-62, 24, {1.0f, 0.84f, 0.66f}, 3.4f});
    Scene scene = stage.finish(kFirstFrom, kFirstTo, 36);
    scene.camera.shutter_open = -0.25f, scene.camera.shutter_close = 0.25f;
    scene.picture.width = 640, scene.picture.height = 360;
    scene.picture.fps = float(kFramesPerSecond);
    progress.add(1);
    return scene;
}

SceneMotion make_shot_motion(const ProgressFunction& on_progress) {
    ProgressCounter progress(on_progress, kFrames);
    const Ocean ocean = make_ocean();
    SceneMotion motion;
    motion.frame_count = kFrames;
    motion.views = {{1, kFirstFrom, kFirstTo}, {double(kFrames), kLastFrom, kLastTo}};
    for (size_t k = 0; k < kFrames; ++k) {
        const std::shared_ptr<const Texture> map = ocean.make_map(get_seconds(k));
        for (const Body& body : kBodies) motion.objects[body.name].push_back(float_body(body, ocean, *map));
        motion.maps["ocean"].push_back(map);
        progress.add(1);
    }
    return motion;
}

} // namespace relief::samples
