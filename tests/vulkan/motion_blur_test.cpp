// Motion blur on a device: the mean of its still pictures, as on the CPU engine.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "relief/session.h"
#include "support/session_scenes.h"

namespace relief::vulkan::tests {

namespace {

/// A body that moves and whose relief grows.
Scene make_moving_scene(double frame) {
    Scene scene = test::make_rough_torus();
    scene.objects[0].world_from_object.translation.x = float(frame);
    scene.displacements[0].scale = scene.displacements[0].scale * (1 + float(frame));
    scene.camera.shutter_open = -0.25f, scene.camera.shutter_close = 0.25f;
    return scene;
}

SceneUpdate update_scene(double frame) {
    Scene scene = make_moving_scene(frame);
    const Camera camera = scene.camera;
    return {std::move(scene), camera, 1};
}

RenderSettings make_blur_settings(int samples) {
    RenderSettings settings = test::make_session_settings();
    settings.device.engine = EngineKind::vulkan;
    settings.device.index = get_test_device_index();
    settings.image.width = 40, settings.image.height = 30, settings.image.spp = samples;
    settings.image.layers = {"motion"};
    return settings;
}

Image render_blur(const RenderSettings& settings) {
    Session session(make_moving_scene(0), settings, SessionUse::scenes);
    return session.render_moving(0, update_scene).image;
}

} // namespace

TEST(DeviceMotionBlur, is_the_mean_of_still_pictures) {
    constexpr int kSamples = 4;
    const Image blur = render_blur(make_blur_settings(kSamples));
    RenderSettings one = make_blur_settings(1);
    std::vector<double> sums(blur.pixels.size());
    for (int k = 0; k < kSamples; ++k) {
        one.image.first_sample = k;
        const Image still =
            render(make_moving_scene(find_sample_time(make_moving_scene(0).camera, 0, k)), one).image;
        for (size_t p = 0; p < sums.size(); ++p) sums[p] += double(still.pixels[p]);
    }
    for (size_t p = 0; p < sums.size(); ++p)
        if (p % blur.channels.size() < 4) ASSERT_EQ(blur.pixels[p], float(sums[p] / kSamples)) << p;
}

TEST(DeviceMotionBlur, says_the_motion_that_the_cpu_engine_says) {
    RenderSettings settings = make_blur_settings(1);
    const Image device = render_blur(settings);
    settings.device.engine = EngineKind::cpu, settings.device.index = -1;
    const Image cpu = render_blur(settings);
    ASSERT_EQ(device.channels, cpu.channels);
    const size_t x = device.find_channel("motion.X").value();
    int other = 0, moving = 0;
    for (int row = 0; row < 30; ++row)
        for (int column = 0; column < 40; ++column) {
            other += std::fabs(device.at(column, row, x) - cpu.at(column, row, x)) > 1e-3f;
            moving += std::fabs(cpu.at(column, row, x)) > 0.5f;
        }
    EXPECT_LE(other, 12) << "rays at an edge";
    EXPECT_GT(moving, 100);
}

} // namespace relief::vulkan::tests
