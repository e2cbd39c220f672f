// Light linking: what lights and what does not, drawn and met, of few lights and of many.
#include <gtest/gtest.h>

#include "support/lit_floor.h"

namespace relief {
namespace {

/// Names the floor; add_object names objects by their meshes.
Scene make_named_floor() {
    Scene scene = make_floor_scene();
    scene.objects[0].name = "floor";
    add_object(scene, make_floor(1), make_matte(0.5f));
    scene.objects[1].name = "far away";
    scene.objects[1].world_from_object.translation = {0, 0, 200};
    return scene;
}

Light make_disk(const Vec3f& position) {
    Light light = make_point(position, 0.5f);
    light.type = LightType::disk;
    return light;
}

/// Enough lights for a tree, which light nothing near.
void add_distant_lights(Scene& scene) {
    for (int k = 0; k < 60; ++k) {
        scene.lights.push_back(make_point({float(k), 1, 200}, 0));
        scene.lights.back().strength = 1e-3f;
    }
}

TEST(LightLinks, only_named_objects_are_lit) {
    for (const bool is_many : {false, true}) {
        Scene scene = make_named_floor();
        scene.lights = {make_sun({0, -1, 0}, 2), make_point({0, 1, 0}, 0.3f), make_point({0, 2, 0}, 0),
                        make_disk({0, 1, 0})};
        if (is_many) add_distant_lights(scene);
        const double sun = 3, near = 5, far = 5 / 4.0, disk = 5 / 1.25;
        expect_irradiance(scene, sun + near + far + disk, 512);
        scene.lights[0].link_includes = {"far away"};
        expect_irradiance(scene, near + far + disk, 512);
        scene.lights[1].link_excludes = {"floor"};
        expect_irradiance(scene, far + disk, 512);
        scene.lights[2].link_excludes = {"far away"}, scene.lights[3].link_includes = {"floor"};
        expect_irradiance(scene, far + disk, 512);
        scene.lights[2].link_includes = {"far away", "floor"};
        scene.lights[3].link_excludes = {"floor"}; // what is excluded is so of those included
        expect_irradiance(scene, far, 512);
    }
}

TEST(LightLinks, mirrors_do_not_show_lights_that_do_not_light_them) {
    for (const bool is_many : {false, true}) {
        Scene scene = make_named_floor();
        scene.materials[0].metallic = 1, scene.materials[0].roughness = 0.05f;
        scene.materials[0].base_color = {1, 1, 1};
        scene.camera.from = {0, 3, 3};
        Light disk = make_disk({0, 2, -2});
        disk.direction = {0, -1, 1};
        scene.lights = {disk};
        if (is_many) add_distant_lights(scene);
        const double shown = compute_covered_mean(render(scene, make_small_settings(4, 64, 2)).image).value;
        EXPECT_NEAR(shown, 5 / (kPi * 0.25), 0.5);
        scene.lights[0].link_excludes = {"floor"};
        const double hidden = compute_covered_mean(render(scene, make_small_settings(4, 64, 2)).image).value;
        EXPECT_LT(hidden, 1e-4);
    }
}

TEST(LightLinks, light_comes_on_from_what_is_lit) {
    // The floor is lit by the wall alone, which is lit by the light.
    Scene scene = make_floor_scene();
    scene.objects[0].name = "floor";
    add_object(scene, make_quad_mesh({Vec3f{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}}),
               make_matte(0.8f));
    scene.objects[1].name = "wall";
    scene.lights = {make_point({0, 1, 1}, 0.1f)};
    scene.lights[0].link_includes = {"wall"};
    EXPECT_EQ(compute_covered_mean(render(scene, make_small_settings(4, 16, 0)).image).value, 0);
    EXPECT_GT(compute_covered_mean(render(scene, make_small_settings(4, 16, 1)).image).value, 0.01);
}

TEST(LightLinks, shadows_fall_from_objects_that_are_not_lit) {
    Scene scene = make_named_floor();
    scene.objects[1].world_from_object.translation = {0, 1, 0};
    scene.camera.from = {0.5f, 0.5f, 0.3f};
    scene.lights = {make_point({0, 2, 0}, 0)};
    scene.lights[0].link_includes = {"floor"};
    expect_irradiance(scene, 0, 16, 0);
}

TEST(LightLinks, cameras_see_lights_whatever_they_light) {
    Scene scene = make_named_floor();
    Light disk = make_disk({0, 1, 0});
    disk.direction = {0.5f, 2, 4}, disk.is_visible_to_camera = true;
    scene.lights = {disk};
    scene.lights[0].link_includes = {"far away"};
    scene.camera.to = disk.position;
    const Image image = render(scene, make_small_settings(4, 4, 1)).image;
    EXPECT_NEAR(image.at(2, 2, image.find_channel("G").value()), 5 / (kPi * 0.25), 1e-2);
}

} // namespace
} // namespace relief
