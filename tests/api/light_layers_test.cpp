// Layers that the light of a picture is shared out over: they add up to its colour, and hold what their names
// say.
#include <gtest/gtest.h>

#include <sstream>
#include <tuple>

#include "relief/error.h"
#include "relief/image.h"
#include "relief/session.h"
#include "support/lit_room.h"
#include "support/saved_film.h"

namespace relief {

namespace {

using test::expect_layers_of_light;
using test::find_mean;
using test::get_color;
using test::make_lit_room;
using test::make_room_settings;

std::string message_of(Scene scene, const RenderSettings& settings) {
    try {
        render(std::move(scene), settings);
        return "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
}

} // namespace

TEST(LightLayers, sum_up_to_a_colour_that_they_leave_as_it_is) {
    for (const float clamp : {0.0f, 0.2f})
        for (const bool has_background : {false, true}) {
            RenderSettings settings = make_room_settings(16);
            settings.image.clamp_indirect = clamp;
            if (has_background) settings.image.background = Vec3f{0.1f, 0.7f, 0.2f};
            const Image image = render(make_lit_room(), settings).image;
            expect_layers_of_light(image);
            for (const std::string layer : kLightKinds) EXPECT_GT(find_mean(image, layer), 1e-3) << layer;
            for (const std::string& layer : test::kRoomGroups)
                EXPECT_GT(find_mean(image, layer), 1e-3) << layer;
            const char* group = has_background ? "light_default" : "light_sky";
            EXPECT_EQ(get_color(image, 0, group), get_color(image, 0, "")) << "behind all surfaces";
            settings.image.layers.clear();
            EXPECT_EQ(test::get_colors(image), render(make_lit_room(), settings).image.pixels);
        }
}

TEST(LightLayers, are_the_same_whichever_of_them_are_asked_for) {
    RenderSettings settings = make_room_settings(4);
    const Image all = render(make_lit_room(), settings).image;
    for (const std::vector<std::string>& some :
         {std::vector<std::string>{"light_sky", "light_key"}, {"emission", "specular_indirect"}}) {
        settings.image.layers = some;
        const Image image = render(make_lit_room(), settings).image;
        EXPECT_EQ(image.channels.size(), 4u + 6u);
        for (const std::string& layer : some)
            for (size_t p = 0; p < size_t(image.width * image.height); ++p)
                ASSERT_EQ(get_color(image, p, layer), get_color(all, p, layer)) << layer;
    }
}

TEST(LightLayers, hold_the_light_that_they_are_named_after) {
    RenderSettings settings = make_room_settings(64);
    Scene scene = make_lit_room();
    for (Material& material : scene.materials)
        material.ior = 1, material.metallic = 0, material.transmission_weight = 0;
    scene.materials[2].coat_weight = 0;
    const Image matte = render(scene, settings).image;
    EXPECT_LT(find_mean(matte, "specular_direct") + find_mean(matte, "specular_indirect"), 1e-7);
    for (Material& material : scene.materials) material.ior = 1.5f, material.metallic = 1;
    scene.materials[2].fuzz_weight = 0;
    const Image metal = render(scene, settings).image;
    EXPECT_EQ(find_mean(metal, "diffuse_direct") + find_mean(metal, "diffuse_indirect"), 0);

    settings.image.spp = 2400;
    scene = make_lit_room();
    for (Material& material : scene.materials) // no mirror, where lights are not found without a bounce
        material.roughness = std::max(material.roughness, 0.35f);
    const Image whole = render(scene, settings).image;
    settings.image.bounces = 0;
    const Image direct = render(scene, settings).image;
    expect_layers_of_light(direct);
    EXPECT_EQ(find_mean(direct, "diffuse_indirect") + find_mean(direct, "specular_indirect"), 0);
    for (const char* layer : {"diffuse_direct", "specular_direct"})
        EXPECT_NEAR(find_mean(direct, layer), find_mean(whole, layer), 0.05 * find_mean(whole, layer));
    for (const char* layer : {"emission", "background"}) // noise of edges alone
        EXPECT_EQ(find_mean(direct, layer), find_mean(whole, layer)) << layer;
    EXPECT_EQ(get_color(whole, 0, "background"), (Vec3f{0.2f, 0.3f, 0.5f}));
    size_t lamps = 0;
    for (size_t p = 9 * 24; p < 18 * 24; ++p) lamps += get_color(whole, p, "emission") == Vec3f{3, 2, 1};
    EXPECT_GT(lamps, 3u) << "pixels that it fills";
}

TEST(LightLayers, of_groups_are_the_pictures_of_their_lights_alone) {
    RenderSettings settings = make_room_settings(400);
    const Image image = render(make_lit_room(), settings).image;
    settings.image.layers.clear();
    for (const std::string& layer : test::kRoomGroups) {
        const std::string group(find_group_of_layer(layer));
        const auto is_other = [&](const std::string& name) {
            return (name.empty() ? kDefaultLightGroup : name) != group;
        };
        Scene scene = make_lit_room();
        std::erase_if(scene.lights, [&](const Light& light) { return is_other(light.light_group); });
        for (Material& material : scene.materials)
            if (is_other(material.light_group)) material.emission = {};
        if (is_other(scene.environment->light_group)) scene.environment.reset();
        const double alone = find_mean(render(scene, settings).image, "");
        EXPECT_NEAR(find_mean(image, layer), alone, 0.03 * alone) << layer;
    }
}

TEST(LightLayers, of_parts_merge_to_those_of_the_whole) {
    const Image whole = render(make_lit_room(), make_room_settings(12)).image;
    std::vector<Image> parts;
    for (const auto& [window, first, count] : {std::tuple{Window{0, 0, 7, 18}, 0, 12},
                                               {Window{7, 0, 24, 18}, 0, 5},
                                               {Window{7, 0, 24, 18}, 5, 7}}) {
        RenderSettings settings = make_room_settings(count);
        settings.image.crop = window, settings.image.first_sample = first;
        parts.push_back(render(make_lit_room(), settings).image);
        expect_layers_of_light(parts.back());
    }
    const Image merged = merge_images(parts);
    ASSERT_EQ(merged.channels, whole.channels);
    for (size_t k = 0; k < whole.pixels.size(); ++k)
        ASSERT_NEAR(merged.pixels[k], whole.pixels[k], 1e-6f * (1 + std::fabs(whole.pixels[k])));
    expect_layers_of_light(merged);
}

TEST(LightLayers, go_on_from_the_sums_of_another_render) {
    RenderSettings settings = make_room_settings(37);
    const Image whole = render(make_lit_room(), settings).image;
    std::ranges::reverse(settings.image.layers); // the order of a request does not matter
    settings.device.threads = 1;
    std::istringstream stream(test::render_film(make_lit_room(), make_room_settings(5)));
    Checkpoints checkpoints;
    checkpoints.resume = &stream;
    EXPECT_EQ(render(make_lit_room(), settings, nullptr, checkpoints).image.pixels, whole.pixels);
    settings.image.layers.front() = "light_key";
    std::istringstream again(test::render_film(make_lit_room(), make_room_settings(5)));
    checkpoints.resume = &again;
    settings.image.layers.pop_back();
    EXPECT_THROW(render(make_lit_room(), settings, nullptr, checkpoints), Error) << "a layer less";
}

TEST(LightLayers, sum_up_where_noise_decides_how_many_samples_there_are) {
    RenderSettings settings = make_room_settings(96);
    settings.image.noise = 0.2f;
    const Image image = render(make_lit_room(), settings).image;
    const size_t samples = image.find_channel("samples.Y").value();
    float least = 96, most = 0;
    for (size_t k = samples; k < image.pixels.size(); k += image.channels.size())
        least = std::min(least, image.pixels[k]), most = std::max(most, image.pixels[k]);
    EXPECT_LT(least, most);
    expect_layers_of_light(image);
}

TEST(LightLayers, stand_in_the_pictures_of_a_session) {
    Session session(make_lit_room(), make_room_settings(4));
    const Image expected = render(make_lit_room(), make_room_settings(4)).image;
    for (int k = 0; k < 2; ++k) EXPECT_EQ(session.render().image.pixels, expected.pixels);
}

TEST(LightLayers, of_groups_that_nothing_is_in_are_refused) {
    RenderSettings settings = make_room_settings(1);
    settings.image.layers = {"light_fill"};
    std::string message = message_of(make_lit_room(), settings);
    EXPECT_NE(message.find("in the group 'fill'"), std::string::npos) << message;
    EXPECT_NE(message.find("default, key, lamp, rim, sky"), std::string::npos) << message;
    Scene plain = make_lit_room();
    plain.lights.clear(), plain.environment.reset();
    for (Material& material : plain.materials) material.emission = {};
    message = message_of(plain, settings);
    EXPECT_NE(message.find("give lights, materials or the environment a light_group"), std::string::npos);
    settings.image.layers = {"light_no name"};
    EXPECT_NE(message_of(make_lit_room(), settings).find("there is no layer"), std::string::npos);
}

TEST(CameraNormals, are_those_of_the_world_along_the_axes_of_the_camera) {
    RenderSettings settings = make_room_settings(3);
    settings.image.layers = {"N", "N_camera"};
    Scene scene = make_lit_room();
    scene.camera.from = {5, 3, 4}, scene.camera.to = {1, 0, 0};
    const Image image = render(scene, settings).image;
    const Vec3f back = normalize(scene.camera.from - scene.camera.to);
    const Vec3f right = normalize(cross(Vec3f{0, 1, 0}, back)), up = cross(back, right);
    const size_t world = image.find_channel("N.X").value(), camera = image.find_channel("N_camera.X").value();
    size_t facing = 0;
    for (const float* values = image.pixels.data(); values < image.pixels.data() + image.pixels.size();
         values += image.channels.size()) {
        const Vec3f n{values[world], values[world + 1], values[world + 2]};
        EXPECT_NEAR(values[camera], dot(right, n), 1e-6f);
        EXPECT_NEAR(values[camera + 1], dot(up, n), 1e-6f);
        EXPECT_NEAR(values[camera + 2], dot(back, n), 1e-6f);
        facing += values[camera + 2] > 0.3f;
    }
    EXPECT_GT(facing, 300u) << "z is towards the viewer";
}

} // namespace relief
