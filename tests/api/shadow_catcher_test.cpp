// Objects that only catch shadows: alpha in place of themselves.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "support/coarse_sphere.h"

namespace relief {
namespace {

Light make_sun(const Vec3f& direction) {
    Light sun;
    sun.direction = direction, sun.angle_degrees = 0, sun.strength = 2;
    return sun;
}

/// A floor alone in the picture, which catches shadows.
Scene make_floor_scene() {
    Scene scene;
    add_object(scene, make_floor(1), make_matte(0.1f));
    scene.objects[0].is_shadow_catcher = true;
    scene.camera.from = {0, 2, 2}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 10;
    return scene;
}

/// At `height` above it and as wide as all of it.
void add_roof(Scene& scene, float height) {
    add_object(scene, make_floor(8), make_matte(0.5f));
    scene.objects.back().world_from_object.translation.y = height;
}

RenderSettings make_catcher_settings(int size, int spp, int bounces) {
    RenderSettings settings = make_small_settings(size, spp, bounces);
    settings.image.background = Vec3f{};
    return settings;
}

double find_mean(const Image& image, const char* channel) {
    double sum = 0;
    const size_t place = image.find_channel(channel).value();
    for (size_t k = place; k < image.pixels.size(); k += image.channels.size()) sum += image.pixels[k];
    return sum / (image.width * image.height);
}

void expect_alpha(const Scene& scene, double alpha, double tolerance) {
    const Image image = render(scene, make_catcher_settings(8, 64, 0)).image;
    EXPECT_NEAR(find_mean(image, "A"), alpha, tolerance);
    for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(find_mean(image, channel), 0);
}

TEST(ShadowCatcher, has_the_alpha_of_what_is_taken_from_its_light) {
    Scene scene = make_floor_scene();
    expect_alpha(scene, 0, 0); // without light nothing is taken
    scene.lights = {make_sun({0, -1, -0.1f})};
    expect_alpha(scene, 0, 0);
    add_roof(scene, 6);
    expect_alpha(scene, 1, 0);
    // From both sides of the roof, of which one is closed; a light of the double strength counts double.
    scene.objects[1].world_from_object.translation = {8.5f, 4, 0};
    scene.lights = {make_sun({-1, -1, 0}), make_sun({1, -1, 0})};
    expect_alpha(scene, 0.5, 0.02);
    scene.lights[0].strength *= 2;
    expect_alpha(scene, 2 / 3.0, 0.02);
    // Light that arrives from below falls upon the other side.
    scene.lights = {make_sun({0, 1, 0})};
    expect_alpha(scene, 0, 0);
}

TEST(ShadowCatcher, lets_through_what_cut_outs_and_clear_walls_do) {
    Scene scene = make_floor_scene();
    scene.lights = {make_sun({0, -1, -0.1f})};
    add_roof(scene, 6);
    scene.materials[1].opacity = 0.25f;
    expect_alpha(scene, 0.25, 0.02);
}

Scene make_sphere_on_floor(bool is_catcher) {
    Scene scene = test::make_sphere_scene(test::make_icosphere(3));
    scene.materials[0].base_color = {0.7f, 0.4f, 0.2f};
    add_object(scene, make_floor(60), make_matte(1));
    scene.objects[1].world_from_object.translation.y = -1;
    scene.objects[1].is_shadow_catcher = is_catcher;
    scene.environment.emplace();
    scene.camera.from = {0, 4, 6}, scene.camera.to = {0, -0.5f, 0}, scene.camera.fov_degrees = 40;
    return scene;
}

TEST(ShadowCatcher, over_white_is_a_white_floor_under_a_white_sky) {
    const Image floor = render(make_sphere_on_floor(false), make_catcher_settings(24, 256, 0)).image;
    const Image caught = render(make_sphere_on_floor(true), make_catcher_settings(24, 256, 0)).image;
    double expected = 0, found = 0, darkest = 1;
    size_t pixels = 0;
    const size_t depth = caught.find_channel("depth.Z").value(), alpha = caught.find_channel("A").value();
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            if (!std::isinf(caught.at(x, y, depth))) continue; // the sphere, or some of it
            ++pixels;
            expected += floor.at(x, y, 1), found += 1 - caught.at(x, y, alpha);
            darkest = std::min<double>(darkest, 1 - caught.at(x, y, alpha));
        }
    EXPECT_GT(pixels, 300u);
    EXPECT_LT(darkest, 0.5);
    EXPECT_NEAR(found, expected, 0.003 * expected);
}

TEST(ShadowCatcher, is_not_seen_but_gives_its_light_to_others) {
    RenderSettings settings = make_catcher_settings(24, 16, 3);
    settings.image.layers = {"depth", "id", "N", "Ng", "P", "albedo", "uv", "CryptoObject", "samples"};
    Scene scene = make_sphere_on_floor(false);
    scene.lights = {make_sun({-1, -2, -1})};
    const Image floor = render(scene, settings).image;
    scene.objects[1].is_shadow_catcher = true;
    const Image caught = render(scene, settings).image;
    const size_t id = caught.find_channel("id.I").value(), alpha = caught.find_channel("A").value();
    const size_t matte = caught.find_channel("CryptoObject00.g").value();
    size_t spheres = 0, shadows = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            if (caught.at(x, y, id) == 0) {
                shadows += caught.at(x, y, alpha) > 0.3f;
                for (size_t c = 0; c < caught.channels.size(); ++c) {
                    const std::string layer = caught.channels[c].substr(0, caught.channels[c].find('.'));
                    if (layer == "A" || layer == "shadow" || layer == "samples") continue;
                    const float value = caught.at(x, y, c);
                    EXPECT_TRUE(value == 0 || (layer == "depth" && std::isinf(value))) << caught.channels[c];
                }
            } else if (caught.at(x, y, matte) == 1) { // wholly
                ++spheres;
                for (size_t c = 0; c < 4; ++c) EXPECT_EQ(caught.at(x, y, c), floor.at(x, y, c));
            }
        }
    EXPECT_GT(spheres, 40u);
    EXPECT_GT(shadows, 5u);
}

TEST(ShadowCatcher, hides_what_is_behind_it_and_is_hidden_by_lights_that_are_seen) {
    Scene scene = make_floor_scene();
    scene.lights = {make_sun({0, -1, -0.1f})};
    add_roof(scene, -1);
    expect_alpha(scene, 0, 0);
    Light light;
    light.type = LightType::disk, light.position = {0, 0.5f, 0.5f}, light.direction = {0, 1, 1};
    light.radius = 3, light.is_visible_to_camera = true;
    scene.lights.push_back(light);
    add_roof(scene, 6); // shadow, if it were seen
    const Image image = render(scene, make_catcher_settings(8, 4, 0)).image;
    EXPECT_EQ(find_mean(image, "A"), 1);
    EXPECT_EQ(find_mean(image, "shadow.C"), 0);
    EXPECT_GT(find_mean(image, "G"), 0);
}

TEST(ShadowCatcher, goes_on_and_is_merged_to_the_picture_of_all_samples) {
    Scene scene = make_sphere_on_floor(true);
    const Image whole = render(scene, make_catcher_settings(24, 20, 1)).image;
    std::stringstream film;
    Checkpoints checkpoints, further;
    checkpoints.save = [&](const std::function<void(std::ostream&)>& write) { film.str(""), write(film); };
    render(scene, make_catcher_settings(24, 13, 1), nullptr, checkpoints);
    further.resume = &film;
    EXPECT_EQ(render(scene, make_catcher_settings(24, 20, 1), nullptr, further).image.pixels, whole.pixels);

    const auto render_part = [&](const Window& crop, int first, int count) {
        RenderSettings settings = make_catcher_settings(24, count, 1);
        settings.image.crop = crop, settings.image.first_sample = first;
        return render(scene, settings).image;
    };
    const std::array tiles{render_part({0, 0, 24, 10}, 0, 20), render_part({0, 10, 24, 24}, 0, 20)};
    EXPECT_EQ(merge_images(tiles).pixels, whole.pixels);
    const std::array ranges{render_part({}, 13, 7), render_part({}, 0, 5), render_part({}, 5, 8)};
    const Image merged = merge_images(ranges);
    size_t other = 0;
    for (size_t k = 0; k < whole.pixels.size(); ++k)
        other += whole.pixels[k] != merged.pixels[k] &&
                 !(std::fabs(whole.pixels[k] - merged.pixels[k]) <= 1e-5f * (1 + std::fabs(whole.pixels[k])));
    EXPECT_EQ(other, 0u);
}

std::string complain(const RenderSettings& settings) {
    try {
        render(make_floor_scene(), settings);
        return "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
}

TEST(ShadowCatcher, needs_a_background_that_shines_through_and_a_fixed_number_of_samples) {
    RenderSettings settings = make_catcher_settings(4, 1, 0);
    EXPECT_EQ(complain(settings), "accepted");
    for (const std::optional<Vec3f>& other : {std::optional<Vec3f>(), std::optional(Vec3f{1, 1, 1})}) {
        settings.image.background = other;
        EXPECT_NE(complain(settings).find("image.background = transparent"), std::string::npos);
    }
    settings = make_catcher_settings(4, 32, 0);
    settings.image.noise = 0.1f;
    EXPECT_NE(complain(settings).find("image.noise = 0"), std::string::npos);
}

TEST(ShadowCatcher, layer_is_dark_without_one) {
    Scene scene = make_floor_scene();
    scene.objects[0].is_shadow_catcher = false;
    RenderSettings settings = make_catcher_settings(4, 4, 0);
    settings.image.layers = {"shadow"};
    const Image image = render(scene, settings).image;
    EXPECT_EQ(find_mean(image, "shadow.C") + find_mean(image, "shadow.U"), 0);
    EXPECT_EQ(find_mean(image, "A"), 1);
}

} // namespace
} // namespace relief
