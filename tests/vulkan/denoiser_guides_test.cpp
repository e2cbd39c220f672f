// Guides of a denoiser on a device: those of the CPU engine.
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "support/guide_scenes.h"
#include "support/lit_room.h"

namespace relief::vulkan::tests {

namespace {

RenderSettings make_settings(EngineKind engine) {
    RenderSettings settings = test::make_guide_settings(19); // in more than one launch
    settings.device.engine = engine;
    settings.device.index = engine == EngineKind::vulkan ? get_test_device_index() : -1;
    return settings;
}

/// Guides of a scene on both engines; `most`: difference of a mean over the picture.
void expect_same_guides(const Scene& scene, float most) {
    const Image device = render(scene, make_settings(EngineKind::vulkan)).image;
    const Image host = render(scene, make_settings(EngineKind::cpu)).image;
    ASSERT_EQ(device.channels, host.channels);
    for (const char* channel : {"guide_albedo.R", "guide_N.X", "albedo.R", "N.X"}) {
        SCOPED_TRACE(channel);
        test::expect_near(test::find_mean_of(device, channel), test::find_mean_of(host, channel), most);
    }
    size_t other = 0;
    for (size_t k = 0; k < device.pixels.size(); ++k)
        other += !(std::fabs(device.pixels[k] - host.pixels[k]) <= 1e-3f * (1 + std::fabs(host.pixels[k])));
    EXPECT_LE(other, device.pixels.size() / 50) << "rays at an edge may hit on one engine only";
}

} // namespace

TEST(DeviceGuides, show_what_is_in_a_mirror_and_behind_a_pane) {
    using test::Wall;
    expect_same_guides(test::make_shown_wall(test::make_mirror({0.5f, 0.9f, 0.7f}, 0), Wall::beside), 1e-4f);
    expect_same_guides(test::make_shown_wall(test::make_pane(0), Wall::behind), 1e-4f);
    expect_same_guides(test::make_shown_wall(test::make_pane(0.4f), Wall::behind), 1e-4f);
    Material solid = test::make_pane(0.05f);
    solid.is_thin_walled = false, solid.transmission_weight = 0.7f, solid.metallic = 0.2f;
    expect_same_guides(test::make_shown_wall(solid, Wall::behind), 1e-4f);
    Material coated = test::make_mirror({0.5f, 0.9f, 0.7f}, 0.05f);
    coated.coat_weight = 1, coated.coat_roughness = 0.05f;
    expect_same_guides(test::make_shown_wall(coated, Wall::beside), 1e-4f);
    Material bright = make_matte(0.3f);
    bright.emission = {2, 0.5f, 0};
    expect_same_guides(test::make_shown_wall(bright, Wall::behind), 1e-4f);
}

TEST(DeviceGuides, are_those_of_the_cpu_engine_in_a_room_and_leave_its_colours_as_they_are) {
    expect_same_guides(test::make_lit_room(), 2e-3f);
    RenderSettings settings = make_settings(EngineKind::vulkan);
    const Image with = render(test::make_lit_room(), settings).image;
    settings.image.layers.clear();
    EXPECT_EQ(test::get_colors(with), render(test::make_lit_room(), settings).image.pixels);
}

TEST(DeviceGuides, of_a_plain_background_go_with_layers_of_light) {
    RenderSettings settings = make_settings(EngineKind::vulkan);
    settings.image.background = Vec3f{0.1f, 0.7f, 0.2f};
    settings.image.layers.insert(settings.image.layers.end(),
                                 {"light_sky", "specular_direct", "CryptoObject"});
    const Image device = render(test::make_lit_room(), settings).image;
    settings.device.engine = EngineKind::cpu, settings.device.index = -1;
    const Image host = render(test::make_lit_room(), settings).image;
    ASSERT_EQ(device.channels, host.channels);
    for (const char* channel : {"guide_albedo.R", "guide_N.X", "light_sky.R", "specular_direct.R"}) {
        SCOPED_TRACE(channel);
        test::expect_near(test::find_mean_of(device, channel), test::find_mean_of(host, channel), 2e-3f);
    }
}

} // namespace relief::vulkan::tests
