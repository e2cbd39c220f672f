// Cryptomatte layers of a device: the ranks of the CPU engine.
#include <array>
#include <bit>
#include <sstream>

#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "image/cryptomatte.h"
#include "relief/render.h"
#include "support/matte_scene.h"

namespace relief::vulkan::tests {

namespace {

RenderSettings make_settings(EngineKind engine, int spp) {
    RenderSettings settings = test::make_wall_settings(spp);
    settings.device.engine = engine;
    settings.device.index = get_test_device_index();
    return settings;
}

std::vector<uint32_t> get_ranks(const Image& image) {
    std::vector<uint32_t> bits;
    const size_t first = image.find_channel("CryptoObject00.r").value();
    for (size_t k = 0; k < image.pixels.size(); ++k)
        if (k % image.channels.size() >= first) bits.push_back(std::bit_cast<uint32_t>(image.pixels[k]));
    return bits;
}

/// Rays at the very edge of a square may hit on one engine only.
void expect_nearly_same_ranks(const Image& a, const Image& b) {
    const std::vector<uint32_t> x = get_ranks(a), y = get_ranks(b);
    ASSERT_EQ(x.size(), y.size());
    size_t other = 0;
    for (size_t k = 0; k < x.size(); ++k) other += x[k] != y[k];
    EXPECT_LE(other, x.size() / 50);
    EXPECT_EQ(a.metadata.at("cryptomatte/3ae39a5/manifest"), b.metadata.at("cryptomatte/3ae39a5/manifest"));
}

} // namespace

TEST(DeviceCryptomatte, has_the_ranks_of_the_cpu_engine) {
    for (const float spacing : {0.7f, 0.3f}) { // some mattes a pixel; more than slots
        const Scene scene = test::make_wall(spacing);
        const Image device = render(scene, make_settings(EngineKind::vulkan, 21)).image;
        expect_nearly_same_ranks(device, render(scene, make_settings(EngineKind::cpu, 21)).image);
    }
}

TEST(DeviceCryptomatte, goes_on_to_the_bits_of_one_render_and_leaves_the_colours_as_they_are) {
    const Scene scene = test::make_wall(0.3f);
    const Image whole = render(scene, make_settings(EngineKind::vulkan, 40)).image;
    std::stringstream film;
    Checkpoints checkpoints;
    checkpoints.save = [&](const std::function<void(std::ostream&)>& write) { film.str(""), write(film); };
    render(scene, make_settings(EngineKind::vulkan, 16), nullptr, checkpoints);
    Checkpoints further;
    further.resume = &film;
    const Image resumed = render(scene, make_settings(EngineKind::vulkan, 40), nullptr, further).image;
    EXPECT_EQ(resumed.pixels, whole.pixels);
    RenderSettings plain = make_settings(EngineKind::vulkan, 40);
    plain.image.layers.clear();
    const Image colors = render(scene, plain).image;
    for (size_t k = 0; k < colors.pixels.size(); ++k)
        ASSERT_EQ(colors.pixels[k], whole.pixels[k / 4 * whole.channels.size() + k % 4]) << k;
}

} // namespace relief::vulkan::tests
