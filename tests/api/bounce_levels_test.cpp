// Levels that bounce rays see, as the settings choose them.
#include <utility>

#include <gtest/gtest.h>

#include "relief/render.h"
#include "support/bodies.h"

namespace relief {

namespace {

/// Rough, so that rays bounce from it to it.
Scene make_bounce_scene() {
    const Displacement displacement =
        test::make_displacement(test::make_random_map(64, 64, 0.15f, 5), DisplacementSpace::tangent);
    Scene scene = test::make_body_scene(test::make_torus(6, 9), displacement);
    scene.camera.from = {0, 0, 4}, scene.camera.to = {0, 0, 0};
    scene.environment = Environment{};
    return scene;
}

RenderResult render_body(BounceLevels bounce_levels, int level, float camera_z = 4) {
    RenderSettings settings;
    settings.image.width = settings.image.height = 96, settings.image.spp = 2, settings.image.bounces = 2;
    settings.surface.level = level, settings.surface.bounce_levels = bounce_levels;
    Scene scene = make_bounce_scene();
    scene.camera.from.z = camera_z;
    return render(std::move(scene), settings);
}

TEST(BounceLevelsSetting, are_those_of_the_camera_with_a_fixed_level_or_on_request) {
    const RenderResult fixed = render_body(BounceLevels::automatic, 4);
    EXPECT_TRUE(fixed.image.pixels == render_body(BounceLevels::camera, 4).image.pixels);
    const RenderResult coarse = render_body(BounceLevels::automatic, kAutoLevel);
    const RenderResult camera = render_body(BounceLevels::camera, kAutoLevel);
    EXPECT_FALSE(coarse.image.pixels == camera.image.pixels);
    EXPECT_GT(coarse.statistics.bottom_built, camera.statistics.bottom_built);
}

TEST(BounceLevelsSetting, are_those_of_the_camera_within_a_body) {
    constexpr float kTubeRadius = 1;
    const RenderResult inner = render_body(BounceLevels::automatic, kAutoLevel, kTubeRadius);
    EXPECT_TRUE(inner.image.pixels ==
                render_body(BounceLevels::camera, kAutoLevel, kTubeRadius).image.pixels);
}

/// An open bowl from within: all its rays go towards the inside of its surface.
TEST(BounceLevelsSetting, are_those_of_the_camera_towards_the_inside_of_a_surface) {
    const auto render_bowl = [](BounceLevels bounce_levels) {
        Scene scene = make_bounce_scene();
        Mesh& mesh = scene.meshes[0] = test::make_cube_sphere(6);
        mesh.face_sizes.resize(mesh.face_sizes.size() / 2);
        mesh.position_indices.resize(mesh.position_indices.size() / 2);
        mesh.uv_indices.resize(mesh.uv_indices.size() / 2);
        scene.displacements[0].scale = {0.2f, 0.2f, 0.2f}; // without folds, whose other side is seen too
        scene.camera.from = {0, 0, 0}, scene.camera.to = {1, 1, 0.8f};
        RenderSettings settings;
        settings.image.width = settings.image.height = 64, settings.image.spp = 2;
        settings.image.bounces = 2, settings.surface.bounce_levels = bounce_levels;
        settings.device.threads = 1; // of two, both may make one tree
        return render(std::move(scene), settings);
    };
    const RenderResult coarse = render_bowl(BounceLevels::automatic),
                       camera = render_bowl(BounceLevels::camera);
    EXPECT_TRUE(coarse.image.pixels == camera.image.pixels);
    EXPECT_GT(coarse.statistics.bounce_rays, 1000u);
    EXPECT_EQ(coarse.statistics.bottom_built, camera.statistics.bottom_built) << "coarser trees were made";
}

} // namespace

} // namespace relief
