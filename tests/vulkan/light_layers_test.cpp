// Layers of light of a device: those of the CPU engine, which add up to the colour.
#include <sstream>

#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "support/lit_room.h"

namespace relief::vulkan::tests {

namespace {

RenderSettings make_layer_settings(int spp) {
    RenderSettings settings = test::make_room_settings(spp);
    settings.device.engine = EngineKind::vulkan;
    settings.device.index = get_test_device_index();
    return settings;
}

Image render_room(const RenderSettings& settings, const Checkpoints& checkpoints = {}) {
    return render(test::make_lit_room(), settings, nullptr, checkpoints).image;
}

/// Rays at an edge may hit on one engine only.
void expect_nearly_same(const Image& a, const Image& b) {
    ASSERT_EQ(a.channels, b.channels);
    size_t other = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k)
        other += !(std::fabs(a.pixels[k] - b.pixels[k]) <= 1e-3f * (1 + std::fabs(b.pixels[k])));
    EXPECT_LE(other, a.pixels.size() / 50);
}

} // namespace

TEST(DeviceLightLayers, are_those_of_the_cpu_engine_and_sum_up_to_the_colour) {
    for (const float clamp : {0.0f, 0.2f}) {
        RenderSettings settings = make_layer_settings(19);
        settings.image.clamp_indirect = clamp;
        settings.image.crop = {1, 2, 24, 18};
        if (clamp > 0) settings.image.background = Vec3f{0.1f, 0.7f, 0.2f};
        const Image device = render_room(settings);
        test::expect_layers_of_light(device);
        const char* group = clamp > 0 ? "light_default" : "light_sky";
        const Vec3f behind = test::get_color(device, 0, group), color = test::get_color(device, 0, "");
        EXPECT_EQ(behind, color) << "behind all surfaces";
        settings.device.engine = EngineKind::cpu, settings.device.index = -1;
        expect_nearly_same(device, render_room(settings));
    }
}

TEST(DeviceLightLayers, leave_the_colours_as_they_are_and_go_on_to_the_bits_of_one_render) {
    const Image whole = render_room(make_layer_settings(20));
    std::stringstream film;
    Checkpoints checkpoints;
    checkpoints.save = [&](const std::function<void(std::ostream&)>& write) { film.str(""), write(film); };
    render_room(make_layer_settings(16), checkpoints);
    Checkpoints further;
    further.resume = &film;
    EXPECT_EQ(render_room(make_layer_settings(20), further).pixels, whole.pixels);
    RenderSettings plain = make_layer_settings(20);
    plain.image.layers.clear();
    EXPECT_EQ(test::get_colors(whole), render_room(plain).pixels);
}

TEST(DeviceLightLayers, go_with_mattes_and_are_there_for_some_alone) {
    RenderSettings settings = make_layer_settings(5);
    const Image whole = render_room(settings);
    for (const std::vector<std::string>& some :
         {std::vector<std::string>{"light_sky", "light_lamp", "CryptoObject"},
          {"specular_direct", "emission"}}) {
        settings.image.layers = some;
        settings.device.engine = EngineKind::vulkan, settings.device.index = get_test_device_index();
        const Image image = render_room(settings);
        for (size_t p = 0; p < size_t(image.width * image.height); ++p)
            for (size_t k = 0; k < 2; ++k)
                ASSERT_EQ(test::get_color(image, p, some[k]), test::get_color(whole, p, some[k])) << some[k];
        settings.device.engine = EngineKind::cpu, settings.device.index = -1;
        expect_nearly_same(image, render_room(settings));
    }
}

TEST(DeviceLightLayers, sum_up_where_noise_decides_how_many_samples_there_are) {
    RenderSettings settings = make_layer_settings(32);
    settings.image.noise = 0.15f;
    test::expect_layers_of_light(render_room(settings));
}

} // namespace relief::vulkan::tests
