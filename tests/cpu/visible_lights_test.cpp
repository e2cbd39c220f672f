// Lights that cameras see: in lenses, behind cut-outs, over backgrounds and far from the origin.
#include <gtest/gtest.h>

#include "support/lit_floor.h"

namespace relief {
namespace {

constexpr double kRadiance = 5 / (kPi * 0.25);

/// A disk that faces the camera five units away, in the middle of the picture, before nothing.
Scene make_disk_scene() {
    Scene scene;
    Light disk = make_point({0, 1, 0}, 0.5f);
    disk.type = LightType::disk, disk.direction = {0, 0, 1}, disk.is_visible_to_camera = true;
    scene.lights = {disk};
    add_object(scene, make_floor(1), make_matte(0));
    scene.objects[0].world_from_object.translation.y = -50;
    scene.camera.from = {0, 1, 5}, scene.camera.to = {0, 1, 0}, scene.camera.fov_degrees = 40;
    return scene;
}

double sum_channel(const Image& image, const char* name) {
    const size_t channel = image.find_channel(name).value();
    double sum = 0;
    for (size_t p = channel; p < image.pixels.size(); p += image.channels.size())
        sum += double(image.pixels[p]);
    return sum;
}

TEST(VisibleLights, are_spread_out_of_focus_and_lose_nothing) {
    Scene scene = make_disk_scene();
    const RenderSettings settings = make_small_settings(32, 64, 0);
    const Image sharp = render(scene, settings).image;
    scene.camera.aperture_radius = 0.25f, scene.camera.focus_distance = 2.5f;
    const Image blurred = render(scene, settings).image;
    for (const char* channel : {"G", "A"})
        EXPECT_NEAR(sum_channel(blurred, channel), sum_channel(sharp, channel),
                    0.02 * sum_channel(sharp, channel));
    const size_t alpha = sharp.find_channel("A").value();
    int of_sharp = 0, of_blurred = 0;
    for (size_t p = alpha; p < sharp.pixels.size(); p += sharp.channels.size())
        of_sharp += sharp.pixels[p] > 0, of_blurred += blurred.pixels[p] > 0;
    EXPECT_GT(of_blurred, of_sharp + 20);
}

TEST(VisibleLights, shine_through_cut_outs_as_far_as_these_let_rays_pass) {
    for (const float opacity : {0.0f, 0.25f, 1.0f}) {
        Scene scene = make_disk_scene();
        Material sheet = make_matte(0);
        sheet.opacity = opacity;
        add_object(scene, make_quad_mesh({Vec3f{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}}), sheet);
        scene.camera.fov_degrees = 0.1f;
        const Image behind = render(scene, make_small_settings(8, 256, 0)).image;
        EXPECT_NEAR(sum_channel(behind, "G") / 64, (1 - double(opacity)) * kRadiance, 0.02 * kRadiance);
        EXPECT_EQ(sum_channel(behind, "A"), 64);
        scene.lights[0].position.z = 2; // before the sheet
        const Image before = render(scene, make_small_settings(8, 16, 0)).image;
        EXPECT_NEAR(sum_channel(before, "G") / 64, kRadiance, 1e-3 * kRadiance);
    }
}

TEST(VisibleLights, cover_the_background_as_far_as_they_cover_pixels) {
    Scene scene = make_disk_scene();
    scene.environment = Environment{};
    RenderSettings settings = make_small_settings(32, 64, 0);
    settings.image.layers = {"depth", "id", "P"};
    const auto with = [&](const std::optional<Vec3f>& background) {
        settings.image.background = background;
        return render(scene, settings).image;
    };
    const Image film = with(Vec3f{}), grey = with(Vec3f{0.5f, 0.5f, 0.5f}), sky = with(std::nullopt);
    const double covered = sum_channel(film, "A");
    const double side = 2 * 5 * std::tan(20 * kPi / 180);
    EXPECT_NEAR(covered, kPi * 0.25 * 32 * 32 / (side * side), 0.02 * covered);
    EXPECT_NEAR(sum_channel(film, "G"), covered * kRadiance, 1e-3 * covered * kRadiance);
    EXPECT_NEAR(sum_channel(grey, "G"), covered * kRadiance + 0.5 * (32 * 32 - covered), 1e-2 * covered);
    EXPECT_NEAR(sum_channel(sky, "G"), covered * kRadiance + 32 * 32, 1e-2 * covered)
        << "the sky is behind it";
    EXPECT_EQ(sum_channel(sky, "A"), covered);
    // Layers are of surfaces.
    EXPECT_EQ(sum_channel(film, "id.I"), 0);
    EXPECT_TRUE(std::isinf(film.at(16, 16, film.find_channel("depth.Z").value())));
    EXPECT_EQ(sum_channel(film, "P.X"), 0);
}

TEST(VisibleLights, are_the_same_far_from_the_origin) {
    const auto render_at = [](const Vec3f& offset) {
        Scene scene = make_disk_scene();
        scene.objects[0].world_from_object.translation = offset;
        scene.lights[0].position = scene.lights[0].position + offset;
        scene.camera.from = scene.camera.from + offset, scene.camera.to = scene.camera.to + offset;
        scene.camera.aperture_radius = 0.125f, scene.camera.focus_distance = 5;
        scene.materials[0] = make_matte(0.7f);
        return render(scene, make_small_settings(16, 64, 1)).image;
    };
    const Image near = render_at({}), far = render_at({1 << 21, 0, -(1 << 20)});
    for (const char* channel : {"G", "A"}) {
        EXPECT_GT(sum_channel(near, channel), 1);
        EXPECT_NEAR(sum_channel(far, channel), sum_channel(near, channel), 1e-2 * sum_channel(near, channel));
    }
}

} // namespace
} // namespace relief
