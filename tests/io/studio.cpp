// The light of a mesh that comes alone: where it comes from, what changes it, and how it is saved.
#include <cmath>
#include <optional>

#include "io/scene/studio.h"
#include "math/vec.h"
#include "relief/aim.h"
#include "relief/io.h"
#include "test_files.h"

namespace relief {

using Studio = FileTest;

Mesh make_wedge(float size) {
    Mesh mesh;
    mesh.name = "wedge";
    for (const Vec3f& p : {Vec3f{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {-1, 2, -1}, {1, 2, -1}})
        mesh.positions.push_back(p * size);
    mesh.face_sizes = {4, 4, 4, 3, 3};
    mesh.position_indices = {3, 2, 1, 0, 0, 1, 5, 4, 2, 3, 4, 5, 0, 4, 3, 1, 2, 5};
    return mesh;
}

/// The way to the key light in the camera's axes: right, up, towards the camera.
Vec3f find_key(const Scene& scene) {
    const Vec3f toward = normalize(scene.camera.from - scene.camera.to);
    const Vec3f right = normalize(cross(scene.camera.up, toward)), up = cross(toward, right);
    const Vec3f to_light = scene.lights.at(0).direction * -1.0f;
    return {dot(to_light, right), dot(to_light, up), dot(to_light, toward)};
}

TEST_F(Studio, the_key_light_comes_from_the_upper_left_of_each_view) {
    for (const View view : {View::front, View::back, View::left, View::right, View::top, View::three_quarter,
                            View::automatic}) {
        Scene scene = make_mesh_scene(make_wedge(1), nullptr);
        aim_scene(scene, {.view = view}, 1);
        ASSERT_EQ(scene.lights.size(), 1u);
        const Vec3f key = find_key(scene);
        EXPECT_LT(key.x, -0.4f) << int(view);
        EXPECT_GT(key.y, 0.3f) << int(view);
        EXPECT_GT(key.z, 0.2f) << int(view);
        EXPECT_LT(scene.lights[0].direction.y, -0.2f) << int(view) << ": from above the floor";
        // The picture of the studio counts from the camera.
        const Vec3f toward = scene.camera.from - scene.camera.to;
        const float azimuth = scene.environment->rotate_degrees * 3.14159265f / 180;
        if (view == View::top)
            EXPECT_EQ(azimuth, 0);
        else
            EXPECT_NEAR(
                dot(normalize(Vec3f{toward.x, 0, toward.z}), Vec3f{std::sin(azimuth), 0, std::cos(azimuth)}),
                1, 1e-5f)
                << int(view);
    }
    Scene below = make_mesh_scene(make_wedge(1), nullptr);
    aim_scene(below, {.from = Vec3f{0, -9, 1}}, 1);
    EXPECT_LT(below.lights[0].direction.y, -0.2f);
}

TEST_F(Studio, the_size_of_a_mesh_does_not_change_its_light) {
    const Scene small = make_mesh_scene(make_wedge(1), nullptr);
    const Scene large = make_mesh_scene(make_wedge(1000), nullptr);
    EXPECT_LT(length(small.lights[0].direction - large.lights[0].direction), 1e-5f);
    EXPECT_EQ(small.lights[0].strength, large.lights[0].strength);
    EXPECT_NEAR(small.environment->rotate_degrees, large.environment->rotate_degrees, 1e-3f);
    EXPECT_EQ(small.environment->texture, large.environment->texture);
}

TEST_F(Studio, light_that_somebody_has_changed_stays) {
    Scene scene = make_mesh_scene(make_wedge(1), nullptr);
    scene.lights[0].direction = {1, 0, 0};
    scene.environment->rotate_degrees = 77;
    aim_scene(scene, {.view = View::back}, 1);
    EXPECT_EQ(scene.lights[0].direction, (Vec3f{1, 0, 0}));
    EXPECT_EQ(scene.environment->rotate_degrees, 77);
    Scene copied = make_mesh_scene(make_wedge(1), nullptr);
    const float placed = copied.environment->rotate_degrees;
    copied.environment->texture = std::make_shared<const Texture>(*get_studio());
    Scene known = copied;
    aim_scene(copied, {.view = View::back}, 1);
    EXPECT_EQ(copied.environment->rotate_degrees, placed) << "as in a scene file";
    recognize_studio(known);
    aim_scene(known, {.view = View::back}, 1);
    EXPECT_NE(known.environment->rotate_degrees, placed);
    EXPECT_LT(find_key(known).x, -0.4f);
}

TEST_F(Studio, options_win_over_it) {
    Scene scene = make_mesh_scene(make_wedge(1), nullptr);
    aim_scene(scene,
              {.view = View::left, .rotate_degrees = 12.0f, .strength = 3.0f, .suns = {{90, 0}, {0, 90}}}, 1);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_LT(length(scene.lights[0].direction - Vec3f{-1, 0, 0}), 1e-6f);
    EXPECT_EQ(scene.environment->rotate_degrees, 12);
    EXPECT_EQ(scene.environment->strength, 3);
    Scene lit = make_mesh_scene(make_wedge(1), nullptr);
    lit.environment->texture.reset(), lit.environment->color = {1, 1, 1};
    complete_mesh_scene(lit);
    EXPECT_EQ(lit.environment->texture, get_studio()) << "a colour is no picture";
    auto sky = std::make_shared<Texture>(*get_studio());
    lit.environment->texture = sky;
    complete_mesh_scene(lit);
    EXPECT_EQ(lit.environment->texture, sky);
    EXPECT_TRUE(lit.lights.empty()) << "the picture of somebody is the only light";
}

TEST_F(Studio, the_ground_has_the_radiance_of_the_backdrop_under_any_sun) {
    for (const std::vector<SunDirection>& suns :
         std::vector<std::vector<SunDirection>>{{}, {{20, 80}}, {{0, 30}, {90, 40}}}) {
        Scene scene = make_mesh_scene(make_wedge(1), nullptr);
        aim_scene(scene, {.strength = 2.0f, .suns = suns, .ground = Ground::plane}, 1);
        const Material& ground = scene.materials.back();
        EXPECT_EQ(ground.ior, 1) << "no reflections";
        const std::optional<Vec3f> color = match_floor(scene);
        ASSERT_TRUE(color);
        EXPECT_EQ(ground.base_color, *color);
    }
    Scene dark = make_mesh_scene(make_wedge(1), nullptr);
    dark.environment->texture = nullptr;
    EXPECT_FALSE(match_floor(dark));
    aim_scene(dark, {.ground = Ground::plane}, 1);
    EXPECT_EQ(dark.materials.back().base_color, (Vec3f{0.5f, 0.5f, 0.5f})) << "grey elsewhere";
}

TEST_F(Studio, a_copy_of_a_scene_has_its_picture_beside_it) {
    const std::filesystem::path input =
        write("plane.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    const Scene scene = load_mesh_scene(input, {});
    const std::filesystem::path file = folder_ / "copy.json";
    save_scene_copy(scene, input, {}, file);
    save_scene_copy(scene, input, {}, file); // over its own files
    const Scene read = load_scene(file);
    ASSERT_TRUE(read.environment && read.environment->texture);
    EXPECT_EQ(read.environment->texture->floats, get_studio()->floats);
    EXPECT_EQ(read.environment->rotate_degrees, scene.environment->rotate_degrees);
    EXPECT_EQ(read.materials[0].base_color, scene.materials[0].base_color);
    EXPECT_EQ(read.materials[0].ior, scene.materials[0].ior);
    EXPECT_EQ(read.lights[0].strength, scene.lights[0].strength);
    write("copy_studio.exr", "mine");
    EXPECT_HAS(message_of([&] { save_scene_copy(scene, input, {}, file); }, ErrorKind::usage),
               "another file would be written over");
}

} // namespace relief
