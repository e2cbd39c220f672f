// Backgrounds of camera rays: the environment, a colour, or nothing; the light of the scene stays.
#include <gtest/gtest.h>

#include <cmath>
#include <exception>

#include "relief/render.h"

namespace relief {
namespace {

/// A quad that covers the middle of the picture, under a constant sky.
Scene make_quad_scene() {
    Scene scene;
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.face_sizes = {4};
    mesh.position_indices = {0, 1, 2, 3};
    scene.meshes.push_back(mesh);
    scene.objects.emplace_back();
    scene.environment = Environment{};
    scene.environment->color = {0.5f, 0.25f, 0.125f};
    scene.camera.from = {0, 0, 6};
    return scene;
}

Image render_with(EngineKind engine, const std::optional<Vec3f>& background) {
    RenderSettings settings;
    settings.device.engine = engine;
    settings.image.width = settings.image.height = 32, settings.image.spp = 4, settings.image.bounces = 1;
    settings.image.background = background;
    return render(make_quad_scene(), settings).image;
}

void expect_background(const Image& image, const Image& sky, const Vec3f& background) {
    for (size_t c = 0; c < 3; ++c) {
        const float expected = c == 0 ? background.x : c == 1 ? background.y : background.z;
        EXPECT_FLOAT_EQ(image.at(1, 1, *image.find_channel(std::string(1, "RGB"[c]))), expected);
        EXPECT_EQ(image.at(16, 16, *image.find_channel(std::string(1, "RGB"[c]))),
                  sky.at(16, 16, *sky.find_channel(std::string(1, "RGB"[c]))))
            << "the light on the quad";
    }
    EXPECT_EQ(image.at(1, 1, *image.find_channel("A")), 0);
    EXPECT_EQ(image.at(16, 16, *image.find_channel("A")), 1);
}

TEST(Background, is_the_environment_a_colour_or_nothing) {
    const Image sky = render_with(EngineKind::cpu, std::nullopt);
    EXPECT_FLOAT_EQ(sky.at(1, 1, *sky.find_channel("R")), 0.5f);
    for (const Vec3f& color : {Vec3f{}, Vec3f{0.1f, 2, 0.3f}})
        expect_background(render_with(EngineKind::cpu, color), sky, color);
}

#ifdef RELIEF_VULKAN
TEST(Background, of_a_device_is_the_same) {
    const Image sky = render_with(EngineKind::vulkan, std::nullopt);
    for (const Vec3f& color : {Vec3f{}, Vec3f{0.1f, 2, 0.3f}})
        expect_background(render_with(EngineKind::vulkan, color), sky, color);
}
#endif

TEST(Background, is_refused_where_it_is_no_colour) {
    EXPECT_THROW(render_with(EngineKind::cpu, Vec3f{-1, 0, 0}), std::exception);
    EXPECT_THROW(render_with(EngineKind::cpu, Vec3f{0, INFINITY, 0}), std::exception);
}

} // namespace
} // namespace relief
