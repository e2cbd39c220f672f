// The render methods find the same hits, bit for bit.
#include "cast_fixture.h"
#include "engine/vulkan/vulkan_engine.h"

namespace relief::vulkan::tests {
namespace {

const std::vector<std::string> kLayers{"depth", "N", "Ng", "P", "albedo", "uv", "id", "cost"};

RenderSettings make_settings() {
    RenderSettings settings;
    settings.engine = EngineKind::vulkan;
    settings.width = 48, settings.height = 32;
    settings.spp = 2, settings.bounces = 1;
    settings.layers = kLayers;
    return settings;
}

struct Picture {
    Image image;
    Statistics statistics;
};

/// On a validated device of its own.
Picture render_with(RenderMethod method, const Scene& scene, RenderSettings settings) {
    settings.method = method;
    auto device = std::make_unique<Device>(
        Device::Config{.index = get_test_device_index(), .method = method, .is_validated = true});
    const Device& used = *device;
    const std::unique_ptr<Engine> engine =
        make_engine_on(std::move(device), prepare_scene(scene, settings), settings);
    Film film(settings.width, settings.height, settings.crop, settings.layers);
    EXPECT_TRUE(engine->render(film, nullptr));
    Picture picture{film.resolve(), {}};
    engine->add_statistics(picture.statistics);
    for (const std::string& message : used.validation_messages()) ADD_FAILURE() << message;
    return picture;
}

void expect_same_bits(const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    size_t other = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k)
        other += std::bit_cast<uint32_t>(a.pixels[k]) != std::bit_cast<uint32_t>(b.pixels[k]);
    EXPECT_EQ(other, 0u) << "of " << a.pixels.size() << " values";
}

size_t count_hits(const Image& image) {
    const size_t depth = image.find_channel("depth.Z").value();
    size_t count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += std::isfinite(image.at(x, y, depth));
    return count;
}

class Methods : public testing::TestWithParam<RenderMethod> {};

INSTANTIATE_TEST_SUITE_P(ThatDraw, Methods, testing::Values(RenderMethod::fragment, RenderMethod::hybrid),
                         [](const auto& info) {
                             return info.param == RenderMethod::fragment ? "fragment" : "hybrid";
                         });

TEST_P(Methods, make_the_picture_that_compute_makes) {
    const Scene scene = make_scene(DisplacementSpace::tangent);
    const Picture expected = render_with(RenderMethod::compute, scene, make_settings());
    const Picture found = render_with(GetParam(), scene, make_settings());
    EXPECT_GT(count_hits(expected.image), 200u);
    expect_same_bits(found.image, expected.image);
    EXPECT_EQ(found.statistics.camera_rays, expected.statistics.camera_rays);
    EXPECT_EQ(found.statistics.shadow_rays, expected.statistics.shadow_rays);
    EXPECT_EQ(found.statistics.bounce_rays, expected.statistics.bounce_rays);
}

} // namespace
} // namespace relief::vulkan::tests
