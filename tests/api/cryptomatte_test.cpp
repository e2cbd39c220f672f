// Cryptomatte layers of whole pictures: names, coverage, and that they do not depend on how a render is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "image/cryptomatte.h"
#include "relief/image.h"
#include "relief/session.h"
#include "support/matte_scene.h"
#include "support/saved_film.h"

namespace relief {

namespace {

/// Coverage of each matte of a pixel, by id.
std::map<uint32_t, float> get_mattes(const Image& image, int x, int y, const std::string& layer) {
    std::map<uint32_t, float> mattes;
    const size_t first = image.find_channel(layer + "00.r").value();
    for (size_t k = first; k < first + 2 * kMatteRanks; k += 2)
        if (image.at(x, y, k + 1) > 0)
            mattes[std::bit_cast<uint32_t>(image.at(x, y, k))] = image.at(x, y, k + 1);
    return mattes;
}

/// Two halves of the plane below y = 0 that meet at x = 0.
Scene make_halves() {
    Scene scene;
    for (const float x : {-50.0f, 0.0f})
        add_object(scene, make_quad_mesh({Vec3f{x, -50, 0}, {x + 50, -50, 0}, {x + 50, 0, 0}, {x, 0, 0}}),
                   make_matte(0.5f));
    scene.objects[0].name = "left", scene.objects[1].name = "right";
    scene.materials[0].name = "red", scene.materials[1].name = "green";
    scene.camera.from = {0, 0, 10}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 40;
    scene.environment = Environment{};
    return scene;
}

RenderSettings make_pixel_settings() {
    RenderSettings settings = test::make_wall_settings(256);
    settings.image.width = settings.image.height = 3;
    return settings;
}

} // namespace

TEST(CryptomatteLayers, have_the_coverage_of_two_halves_of_a_pixel) {
    const Image image = render(make_halves(), make_pixel_settings()).image;
    for (const auto& [layer, names] :
         {std::pair{"CryptoObject", std::pair{"left", "right"}}, {"CryptoMaterial", {"red", "green"}}}) {
        auto mattes = get_mattes(image, 1, 1, layer);
        EXPECT_EQ(mattes.size(), 2u);
        EXPECT_NEAR(mattes[make_matte_id(names.first)], 0.25f, 0.01f);
        EXPECT_NEAR(mattes[make_matte_id(names.second)], 0.25f, 0.01f);
        EXPECT_TRUE(get_mattes(image, 1, 0, layer).empty()) << "the sky";
        mattes = get_mattes(image, 0, 2, layer);
        EXPECT_EQ(mattes.size(), 1u);
        EXPECT_EQ(mattes[make_matte_id(names.first)], 1);
    }
}

TEST(CryptomatteLayers, sum_up_to_alpha_where_no_more_mattes_are_seen_than_there_are_ranks) {
    const Image image = render(test::make_wall(0.7f), test::make_wall_settings(64)).image;
    size_t most = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (const char* layer : {"CryptoObject", "CryptoMaterial"}) {
                float sum = 0;
                const auto mattes = get_mattes(image, x, y, layer);
                for (const auto& [id, coverage] : mattes) sum += coverage;
                most = std::max(most, mattes.size());
                EXPECT_NEAR(sum, image.at(x, y, 3), 1e-6f) << x << ' ' << y;
            }
    EXPECT_GE(most, 4u);
}

TEST(CryptomatteLayers, name_what_has_no_name) {
    Scene scene = make_halves();
    scene.objects[0].name.clear(), scene.meshes[0].name = "quad", scene.objects[0].material = kNoIndex;
    scene.objects[1].name.clear(), scene.meshes[1].name.clear(), scene.materials[1].name.clear();
    const Image image = render(scene, make_pixel_settings()).image;
    EXPECT_EQ(image.metadata.at("cryptomatte/3ae39a5/manifest"),
              "{\"mesh 2\":\"" + fmt::format("{:08x}", make_matte_id("mesh 2")) + "\",\"quad\":\"" +
                  fmt::format("{:08x}", make_matte_id("quad")) + "\"}");
    EXPECT_EQ(image.metadata.at("cryptomatte/be359d6/manifest"),
              "{\"default\":\"42c9679f\",\"material 2\":\"" +
                  fmt::format("{:08x}", make_matte_id("material 2")) + "\"}");
    EXPECT_EQ(get_mattes(image, 0, 2, "CryptoObject").begin()->first, make_matte_id("quad"));
}

TEST(CryptomatteLayers, of_one_name_are_one_matte) {
    Scene scene = make_halves();
    scene.objects[1].name = "left";
    const auto mattes = get_mattes(render(scene, make_pixel_settings()).image, 1, 2, "CryptoObject");
    EXPECT_EQ(mattes, (std::map<uint32_t, float>{{make_matte_id("left"), 1.0f}}));
}

/// More mattes than slots: what is kept of them depends on the order of the samples alone.
TEST(CryptomatteLayers, do_not_depend_on_threads_nor_on_where_a_render_was_interrupted) {
    const Scene scene = test::make_wall(0.3f);
    RenderSettings settings = test::make_wall_settings(37);
    const Image whole = render(scene, settings).image;
    settings.device.threads = 1;
    EXPECT_EQ(render(scene, settings).image.pixels, whole.pixels);
    for (const int first : {1, 5, 16, 36}) {
        std::istringstream stream(test::render_film(scene, test::make_wall_settings(first)));
        Checkpoints checkpoints;
        checkpoints.resume = &stream;
        EXPECT_EQ(render(scene, settings, nullptr, checkpoints).image.pixels, whole.pixels) << first;
    }
}

TEST(CryptomatteLayers, of_parts_merge_to_those_of_the_whole) {
    const Scene scene = test::make_wall(0.7f);
    const Image whole = render(scene, test::make_wall_settings(24)).image;
    std::vector<Image> parts;
    for (const auto& [window, first, count] :
         {std::tuple{Window{0, 0, 2, 4}, 0, 24}, {Window{2, 0, 6, 4}, 0, 9}, {Window{2, 0, 6, 4}, 9, 15}}) {
        RenderSettings settings = test::make_wall_settings(count);
        settings.image.crop = window, settings.image.first_sample = first;
        parts.push_back(render(scene, settings).image);
    }
    const Image merged = merge_images(parts);
    EXPECT_EQ(merged.metadata, whole.metadata);
    const size_t mattes = whole.find_channel("CryptoObject00.r").value();
    for (size_t k = 0; k < whole.pixels.size(); ++k)
        if (k % whole.channels.size() >= mattes) EXPECT_EQ(merged.pixels[k], whole.pixels[k]) << k;
}

TEST(CryptomatteLayers, are_shares_of_the_samples_that_a_pixel_has) {
    RenderSettings settings = test::make_wall_settings(64);
    settings.image.noise = 0.05f;
    const Image image = render(test::make_wall(0.7f), settings).image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            float sum = 0;
            for (const auto& [id, coverage] : get_mattes(image, x, y, "CryptoObject")) sum += coverage;
            EXPECT_NEAR(sum, image.at(x, y, 3), 1e-6f);
        }
}

TEST(CryptomatteLayers, stand_in_the_pictures_of_a_session) {
    const Scene scene = test::make_wall(0.7f);
    const RenderSettings settings = test::make_wall_settings(4);
    Session session(scene, settings);
    const Image expected = render(scene, settings).image;
    for (int k = 0; k < 2; ++k) {
        const Image image = session.render().image;
        EXPECT_EQ(image.pixels, expected.pixels);
        EXPECT_EQ(image.metadata, expected.metadata);
    }
}

} // namespace relief
