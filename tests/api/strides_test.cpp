// Images with as many values a texel as they have channels give the same pictures as those with four.
#include <tuple>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/session.h"
#include "support/isas.h"
#include "support/strides.h"

namespace relief::test {

namespace {

using Kind = std::tuple<uint32_t, SampleType, MapFilter>;

class Strides : public testing::TestWithParam<Kind> {
  protected:
    static RenderSettings make_settings() {
        RenderSettings settings = make_session_settings();
        settings.image.width = 48, settings.image.height = 36;
        return settings;
    }
    static Scene make_wide() {
        const auto [channels, type, filter] = GetParam();
        return make_textured_torus(channels, type, filter);
    }
};

TEST_P(Strides, give_the_same_picture) {
    RenderSettings settings = make_settings();
    const Scene wide = make_wide(), narrow = make_narrow(wide);
    ASSERT_LT(narrow.displacements[0].tiles[0].texture->byte_count(),
              wide.displacements[0].tiles[0].texture->byte_count() * 0.76);
    const std::vector<float> expected = render(wide, settings).image.pixels;
    for (const Isa isa : machine_isas()) {
        settings.device.isa = isa;
        EXPECT_TRUE(render(narrow, settings).image.pixels == expected) << int(isa);
    }
}

TEST_P(Strides, take_the_same_edits) {
    const RenderSettings settings = make_settings();
    const Scene wide = make_wide();
    const uint32_t channels = std::get<0>(GetParam());
    MapEdit edit;
    edit.displacement = "map", edit.x = 20, edit.y = 7;
    edit.texels = *make_wide_map(channels, SampleType::float32, 0.1f, 9);
    edit.texels.height = 12, edit.texels.width = 20;
    edit.texels.floats.resize(edit.texels.value_count());
    Session session(wide, settings);
    session.edit(edit);
    const Image expected = session.render().image;
    MapEdit narrow_edit = edit;
    narrow_edit.texels = make_narrow(edit.texels, channels);
    for (const MapEdit& made : {edit, narrow_edit}) {
        Session narrow(make_narrow(wide), settings);
        const Image before = narrow.render().image;
        narrow.edit(made);
        const Image after = narrow.render().image;
        EXPECT_TRUE(after.pixels == expected.pixels);
        EXPECT_FALSE(after.pixels == before.pixels);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Strides,
    testing::Combine(testing::Values(1u, 3u), testing::Values(SampleType::float16, SampleType::float32),
                     testing::Values(MapFilter::none, MapFilter::mip, MapFilter::cubic)));

/// What a vector map of one channel lacks is 0, not what its neighbours hold.
TEST(Strides, of_one_serve_as_vectors) {
    RenderSettings settings = make_session_settings();
    settings.image.width = 48, settings.image.height = 36;
    for (const MapFilter filter : {MapFilter::none, MapFilter::cubic}) {
        Scene wide = make_textured_torus(1, SampleType::float16, filter);
        wide.displacements[0].type = DisplacementType::vector;
        for (const Isa isa : machine_isas()) {
            settings.device.isa = isa;
            EXPECT_TRUE(render(make_narrow(wide), settings).image.pixels ==
                        render(wide, settings).image.pixels);
        }
    }
}

TEST(Strides, that_do_not_fit_are_refused) {
    const RenderSettings settings = make_session_settings();
    const Scene scene = make_narrow(make_textured_torus(3, SampleType::float32, MapFilter::none));
    const auto expect_refused = [&](auto change) {
        Scene changed = scene;
        auto map = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
        change(*map);
        changed.displacements[0].tiles[0].texture = map;
        EXPECT_THROW(render(changed, settings), Error);
    };
    expect_refused([](Texture& map) { map.floats.pop_back(); });
    expect_refused([](Texture& map) { map.channel_count = 4; });
    expect_refused([](Texture& map) { map.stride = 4; });
    expect_refused([](Texture& map) { map.stride = 0, map.channel_count = 0; });
    expect_refused([](Texture& map) {
        map.stride = map.channel_count = 2;
        map.floats.resize(map.value_count());
    });
}

} // namespace

} // namespace relief::test
