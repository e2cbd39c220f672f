// Rectangles, disks and spots against closed forms, and which lights cameras see.
#include <gtest/gtest.h>

#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "support/lit_floor.h"

namespace relief {
namespace {

Light make_shaped(LightType type, const Vec3f& position, const Vec3f& direction) {
    Light light;
    light.type = type;
    light.position = position;
    light.direction = direction;
    light.strength = 5;
    return light;
}

TEST(ShapedLights, rectangle_has_its_form_factor_and_none_behind) {
    for (float half : {0.2f, 1.0f, 3.0f})
        for (int bounces : {0, 1}) {
            Scene scene = make_floor_scene();
            Light light = make_shaped(LightType::rectangle, {half, 1, 0}, {0, -2, 0});
            light.width = 2 * half, light.height = 4 * half; // its width lies along x, as -z is up
            scene.lights = {light};
            const double radiance = 5.0 / (8 * half * half);
            expect_irradiance(scene, radiance * kPi * 2 * corner_form_factor(2 * half, 2 * half), 1024,
                              bounces);
            scene.lights[0].direction = {0, 1, 0};
            expect_irradiance(scene, 0, 8, bounces);
        }
}

TEST(ShapedLights, disk_has_its_form_factor_and_none_behind) {
    for (float radius : {0.2f, 1.0f, 3.0f})
        for (int bounces : {0, 1}) {
            Scene scene = make_floor_scene();
            scene.lights = {make_shaped(LightType::disk, {0, 1, 0}, {0, -1, 0})};
            scene.lights[0].radius = radius;
            expect_irradiance(scene, 5 / (1.0 + radius * radius), 512, bounces);
            scene.lights[0].direction = {0, 1, 0};
            expect_irradiance(scene, 0, 8, bounces);
        }
}

TEST(ShapedLights, flat_lights_far_away_equal_a_point_light_times_the_cosine) {
    for (LightType type : {LightType::rectangle, LightType::disk}) {
        Scene scene = make_floor_scene();
        Light light = make_shaped(type, {30, 30, 0}, {0, -1, 0});
        light.radius = 0.1f, light.width = 0.3f, light.height = 0.2f;
        scene.lights = {light};
        expect_irradiance(std::move(scene), 5 / 1800.0 / 2, 32);
    }
}

TEST(ShapedLights, spot_shines_in_its_cone_alone) {
    for (float radius : {0.0f, 0.3f}) {
        const auto expect = [&](double tilt_degrees, float blend, double part) {
            Scene scene = make_floor_scene();
            const double tilt = tilt_degrees * kPi / 180;
            scene.lights = {
                make_shaped(LightType::spot, {0, 2, 0}, {float(std::sin(tilt)), -float(std::cos(tilt)), 0})};
            scene.lights[0].cone_degrees = 60, scene.lights[0].blend = blend, scene.lights[0].radius = radius;
            expect_irradiance(std::move(scene), part * 5 / 4, radius > 0 ? 512 : 16);
        };
        const double seen = radius > 0 ? std::asin(radius / 2) * 180 / kPi : 0; // half angle of its sphere
        expect(0, 0, 1);
        expect(29 - seen, 0, 1);
        expect(31 + seen, 0, 0);
        expect(31 + seen, 1, 0);
        if (radius > 0) continue;
        // A smooth step between the cosines of 30 and 15 degrees.
        const auto height = [](double degrees) { return 1 - std::cos(degrees * kPi / 180); };
        const double x = (height(30) - height(24)) / (height(30) - height(15));
        expect(24, 0.5f, x * x * (3 - 2 * x));
        expect(14, 0.5f, 1);
    }
}

/// Light of the pixels of a camera that looks at one light, or past it.
double look_at(const Light& light, const Vec3f& from, bool is_before_background = false) {
    Scene scene;
    add_object(scene, make_floor(10), make_matte(0));
    scene.objects[0].world_from_object.translation.y = -50;
    scene.lights = {light};
    scene.camera.from = from, scene.camera.to = {0, 1, 0}, scene.camera.fov_degrees = 0.1f;
    RenderSettings settings = make_small_settings(4, 4, 2);
    if (is_before_background) settings.image.background = Vec3f{0, 0.25f, 0};
    const Image image = render(std::move(scene), settings).image;
    const float seen = image.at(2, 2, image.find_channel("G").value());
    const bool is_light = seen > (is_before_background ? 0.25f : 0.0f);
    EXPECT_EQ(image.at(2, 2, image.find_channel("A").value()), is_light ? 1 : 0);
    return seen;
}

TEST(ShapedLights, cameras_see_the_lights_that_are_to_be_seen) {
    Light point = make_point({0, 1, 0}, 0.5f), sun = make_sun({0, 0, 1}, 2);
    Light rectangle = make_shaped(LightType::rectangle, {0, 1, 0}, {0, 0, 1});
    rectangle.width = 4, rectangle.height = 0.5f;
    Light disk = make_shaped(LightType::disk, {0, 1, 0}, {0, 0, 1});
    Light spot = make_shaped(LightType::spot, {0, 1, 0}, {0, 0, 1});
    disk.radius = spot.radius = 0.5f;
    const double half_angle = kPi / 180, sun_radiance = 3 / (kPi * std::pow(std::sin(half_angle), 2));
    const double round = 5 / (kPi * 0.25);
    const std::pair<Light, double> cases[] = {
        {point, round}, {sun, sun_radiance}, {rectangle, 5 / 2.0}, {disk, round}, {spot, round}};
    for (auto [light, radiance] : cases) {
        EXPECT_EQ(look_at(light, {0, 1, 5}), 0) << int(light.type);
        light.is_visible_to_camera = true;
        EXPECT_NEAR(look_at(light, {0, 1, 5}), radiance, 1e-4 * radiance) << int(light.type);
        EXPECT_NEAR(look_at(light, {0, 1, 5}, true), radiance, 1e-4 * radiance) << int(light.type);
        const bool is_round = light.type == LightType::point;
        EXPECT_NEAR(look_at(light, {0, 1, -5}, true), is_round ? radiance : 0.25, 1e-4 * radiance);
        EXPECT_NEAR(look_at(light, {0, 1, -5}), is_round ? radiance : 0, 1e-4 * radiance) << int(light.type);
    }
}

TEST(ShapedLights, visible_lights_give_surfaces_the_same_light) {
    for (LightType type : {LightType::point, LightType::rectangle, LightType::disk, LightType::spot}) {
        Scene scene = make_floor_scene();
        scene.lights = {make_shaped(type, {0, 1.5f, 0}, {0, -1, 0})};
        scene.lights[0].radius = 0.4f;
        const Image hidden = render(scene, make_small_settings(8, 8, 2)).image;
        scene.lights[0].is_visible_to_camera = true;
        EXPECT_EQ(render(scene, make_small_settings(8, 8, 2)).image.pixels, hidden.pixels);
    }
}

TEST(ShapedLights, surfaces_hide_visible_lights) {
    Scene scene = make_floor_scene();
    scene.lights = {make_shaped(LightType::disk, {0, -1, 0}, {0, 1, 0})};
    scene.lights[0].radius = 3, scene.lights[0].is_visible_to_camera = true;
    expect_irradiance(std::move(scene), 0, 8);
}

/// Light that a metal floor sends to the camera of make_floor_scene from a light on a face, by a fine grid.
double integrate_reflection(const Light& light, float roughness, const Vec3f& from) {
    const scalar::Basis up = scalar::make_basis({0, 1, 0});
    const Vec3f wo = scalar::to_local(up, normalize(from));
    const scalar::Bsdf bsdf = scalar::make_bsdf({{0.9f, 0.9f, 0.9f}, roughness, 1, 1.5f}, wo.z);
    const bool is_disk = light.type == LightType::disk;
    const Vec3f facing = normalize(light.direction), width = normalize(cross(Vec3f{0, 1, 0}, facing));
    const Vec3f height = cross(facing, width);
    const float half_width = is_disk ? light.radius : light.width / 2;
    const float half_height = is_disk ? light.radius : light.height / 2;
    constexpr int fine = 500;
    double sum = 0, area = 0;
    for (int j = 0; j < fine; ++j)
        for (int i = 0; i < fine; ++i) {
            const float x = 2 * (float(i) + 0.5f) / fine - 1, y = 2 * (float(j) + 0.5f) / fine - 1;
            if (is_disk && x * x + y * y > 1) continue;
            area += 4.0 * double(half_width * half_height) / (fine * fine);
            const Vec3f at = light.position + width * (x * half_width) + height * (y * half_height);
            const float distance = length(at), cosine = -dot(at / distance, facing);
            if (cosine <= 0 || at.y <= 0) continue;
            const Vec3f wi = scalar::to_local(up, at / distance);
            sum += double(scalar::evaluate_bsdf(bsdf, wo, wi).value.y * cosine / (distance * distance));
        }
    return sum * 4 * double(half_width * half_height) / (fine * fine) * double(light.strength) / area;
}

/// Of a nearly smooth surface most of the light is found by its own rays, of a rough one by those to lights.
TEST(ShapedLights, are_weighed_rightly_at_every_roughness) {
    for (const float roughness : {0.05f, 0.1f, 0.2f, 0.5f})
        for (LightType type : {LightType::rectangle, LightType::disk}) {
            Scene scene = make_floor_scene();
            scene.materials[0].metallic = 1, scene.materials[0].roughness = roughness;
            scene.materials[0].base_color = {0.9f, 0.9f, 0.9f}, scene.materials[0].ior = 1.5f;
            // Its edge lies in the mirror image of the camera.
            Light light = make_shaped(type, {-0.5f, 3, -4}, {0.1f, -0.8f, 1});
            light.radius = 0.5f, light.width = 1, light.height = 0.6f;
            // Another one that is drawn as often and lights nothing here.
            Light other = make_point({0, 1, 0}, 0);
            other.color = {0.5f, 0, 0.5f};
            scene.lights = {light, other};
            const double expected = integrate_reflection(light, roughness, scene.camera.from);
            const RenderResult result = render(std::move(scene), make_small_settings(8, 1024, 1));
            const Mean mean = compute_covered_mean(result.image);
            EXPECT_NEAR(mean.value, expected, 0.01 * expected + 4 * mean.standard_error)
                << roughness << ' ' << int(type);
            EXPECT_LT(mean.standard_error, 0.02 * expected) << roughness << ' ' << int(type);
        }
}

/// One light beside another, so that it is drawn seldom: found by chance or drawn, it must give the same.
TEST(ShapedLights, shaped_lights_add_up_whatever_their_shares) {
    Scene scene = make_floor_scene();
    Light disk = make_shaped(LightType::disk, {0, 1, 0}, {0, -1, 0});
    Light spot = make_shaped(LightType::spot, {0, 2, 0}, {0, -1, 0});
    disk.radius = 1, spot.radius = 0.2f;
    scene.lights = {disk, spot, make_point({0, 3, 0}, 0)};
    expect_irradiance(std::move(scene), 5 / 2.0 + 5 / 4.0 + 5 / 9.0, 512);
}

} // namespace
} // namespace relief
