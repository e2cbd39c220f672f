// Guides of a denoiser: what is seen in mirrors and through clear glass, and what blurs it otherwise.
#include <gtest/gtest.h>

#include <sstream>

#include "relief/image.h"
#include "support/guide_scenes.h"
#include "support/lit_room.h"

namespace relief {

namespace {

using test::expect_near;
using test::find_mean_of;
using test::kSkyColor;
using test::kWallColor;
using test::make_guide_settings;
using test::make_mirror;
using test::make_pane;
using test::make_shown_wall;
using test::Wall;

Image render_guides(const Scene& scene, int spp = 64) {
    return render(scene, make_guide_settings(spp)).image;
}

/// What a smooth pane in air lets through straight on, all reflections between its faces counted.
float find_passed(float ior) {
    const float root = (ior - 1) / (ior + 1), fresnel = root * root;
    return (1 - fresnel) / (1 + fresnel);
}

} // namespace

TEST(DenoiserGuides, show_what_is_in_a_mirror_in_the_colour_of_the_mirror) {
    const Vec3f color{0.5f, 0.9f, 0.7f};
    const Image image = render_guides(make_shown_wall(make_mirror(color, 0), Wall::beside));
    // Schlick's Fresnel at 45 degrees adds 0.2 % of what is lacking.
    expect_near(find_mean_of(image, "guide_albedo.R"), color * kWallColor, 0.002f);
    expect_near(find_mean_of(image, "guide_N.X"), {-1, 0, 0}, 1e-3f);
    const float half = std::sqrt(0.5f);
    expect_near(find_mean_of(image, "albedo.R"), color, 1e-5f);
    expect_near(find_mean_of(image, "N.X"), {half, 0, half}, 1e-3f);
}

TEST(DenoiserGuides, show_what_is_behind_a_pane_and_what_it_reflects) {
    for (const bool is_solid : {false, true}) {
        Material pane = make_pane(0);
        pane.is_thin_walled = !is_solid;
        Scene scene = make_shown_wall(pane, Wall::behind);
        if (is_solid) { // its other face
            add_object(scene,
                       make_quad_mesh({Vec3f{1, -1, -0.2f}, {-1, -1, -0.2f}, {-1, 1, -0.2f}, {1, 1, -0.2f}}),
                       pane);
            scene.objects.back().material = 0;
        }
        const Image image = render_guides(scene, 1024);
        const float passed = find_passed(pane.ior);
        expect_near(find_mean_of(image, "guide_albedo.R"), kWallColor * passed + kSkyColor * (1 - passed),
                    0.01f);
        // The sky in the pane faces the path that comes from it: away from the camera.
        expect_near(find_mean_of(image, "guide_N.X"), {0, 0, passed - (1 - passed)}, 0.02f);
    }
}

TEST(DenoiserGuides, are_those_of_surfaces_that_blur) {
    const Vec3f color{0.5f, 0.9f, 0.7f};
    const Image metal = render_guides(make_shown_wall(make_mirror(color, 0.5f), Wall::behind), 4);
    expect_near(find_mean_of(metal, "guide_albedo.R"), color, 1e-5f);
    expect_near(find_mean_of(metal, "guide_N.X"), {0, 0, 1}, 1e-5f);
    const Image pane = render_guides(make_shown_wall(make_pane(0.5f), Wall::behind), 4);
    expect_near(find_mean_of(pane, "guide_albedo.R"), {1, 1, 1}, 1e-5f);
    expect_near(find_mean_of(pane, "guide_N.X"), {0, 0, 1}, 1e-5f);
    Material coated = make_mirror(color, 0.05f);
    coated.coat_weight = 1, coated.coat_roughness = 0.6f;
    const Image blurred = render_guides(make_shown_wall(coated, Wall::behind), 4);
    expect_near(find_mean_of(blurred, "guide_albedo.R"), color, 1e-5f);
    coated.coat_roughness = 0; // a mirror again: the coat is clear
    const Image clear = render_guides(make_shown_wall(coated, Wall::beside), 64);
    EXPECT_LT(find_mean_of(clear, "guide_N.X").x, -0.8f);
}

TEST(DenoiserGuides, are_albedo_and_normal_of_matte_surfaces_and_end_with_the_path) {
    Scene scene = make_shown_wall(make_matte(0.3f), Wall::behind);
    scene.materials[0].emission = {2, 0.5f, 0};
    Image image = render_guides(scene, 4);
    expect_near(find_mean_of(image, "guide_albedo.R"), {1, 0.8f, 0.3f}, 1e-5f);
    expect_near(find_mean_of(image, "guide_N.X"), {0, 0, 1}, 1e-5f);
    RenderSettings settings = make_guide_settings(4);
    settings.image.bounces = 0;
    image = render(make_shown_wall(make_mirror({0.5f, 0.9f, 0.7f}, 0), Wall::beside), settings).image;
    expect_near(find_mean_of(image, "guide_albedo.R"), {0.5f, 0.9f, 0.7f}, 1e-5f);
    scene.camera.to = {0, 0, 10};
    image = render_guides(scene, 4);
    expect_near(find_mean_of(image, "guide_albedo.R"), kSkyColor, 1e-5f);
    expect_near(find_mean_of(image, "guide_N.X"), {}, 0);
}

TEST(DenoiserGuides, leave_all_else_as_it_is_and_go_with_layers_of_light) {
    RenderSettings settings = test::make_room_settings(4);
    const Image without = render(test::make_lit_room(), settings).image;
    for (const char* guide : kDenoiserGuides) settings.image.layers.emplace_back(guide);
    const Image with = render(test::make_lit_room(), settings).image;
    const size_t count = size_t(with.width * with.height);
    for (size_t c = 0; c < without.channels.size(); ++c) {
        const size_t at = with.find_channel(without.channels[c]).value();
        for (size_t p = 0; p < count; ++p)
            ASSERT_EQ(with.pixels[p * with.channels.size() + at],
                      without.pixels[p * without.channels.size() + c])
                << without.channels[c];
    }
    settings.image.layers = {kDenoiserGuides[1]}; // one alone
    const Image one = render(test::make_lit_room(), settings).image;
    EXPECT_EQ(find_mean_of(one, "guide_N.X"), find_mean_of(with, "guide_N.X"));
    EXPECT_EQ(one.channels.size(), 7u);
}

TEST(DenoiserGuides, go_with_the_direct_light_of_a_picture) {
    RenderSettings settings = test::make_room_settings(4);
    const Image kinds = render(test::make_lit_room(), settings).image;
    settings.image.layers = {kDirectLayer};
    const Image image = render(test::make_lit_room(), settings).image;
    EXPECT_EQ(image.channels.size(), 7u);
    for (size_t p = 0; p < size_t(image.width * image.height); ++p) {
        Vec3f sum{};
        for (const char* layer :
             {"diffuse_direct", "specular_direct", "transmission_direct", "emission", "background"})
            sum += test::get_color(kinds, p, layer);
        expect_near(test::get_color(image, p, kDirectLayer), sum, 1e-5f * (1 + sum.x + sum.y + sum.z));
    }
}

TEST(DenoiserGuides, are_gone_on_with_and_joined) {
    RenderSettings settings = make_guide_settings(8);
    const Image whole = render(test::make_lit_room(), settings).image;
    std::stringstream film;
    Checkpoints first, further;
    first.save = [&](const std::function<void(std::ostream&)>& write) { film.str(""), write(film); };
    further.resume = &film;
    settings.image.spp = 4;
    render(test::make_lit_room(), settings, nullptr, first);
    settings.image.spp = 8;
    EXPECT_EQ(render(test::make_lit_room(), settings, nullptr, further).image.pixels, whole.pixels);

    std::vector<Image> parts;
    settings.image.layers.emplace_back("samples");
    for (settings.image.first_sample = 0; settings.image.first_sample < 8; settings.image.first_sample += 4) {
        settings.image.spp = 4;
        parts.push_back(render(test::make_lit_room(), settings).image);
    }
    const Image joined = merge_images(parts);
    for (const char* channel : {"guide_albedo.R", "guide_N.X"})
        expect_near(find_mean_of(joined, channel), find_mean_of(whole, channel), 1e-6f);
}

} // namespace relief
