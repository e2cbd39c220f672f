// Glass in pictures: bodies that refract and absorb, and thin walls, which rays to lights pass too.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/tracer.h"
#include "formulas/ggx_albedo.h"
#include "formulas/ggx_table.h"
#include "formulas/glass_bsdf.h"
#include "prepare/material_glass.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

Material make_glass(float roughness) {
    Material m;
    m.roughness = roughness, m.transmission_weight = 1;
    return m;
}

Material make_wall(const Vec3f& color) {
    Material m = make_glass(0);
    m.is_thin_walled = true, m.transmission_color = color;
    return m;
}

/// Over the whole picture.
Vec3<double> render_average(Scene scene, const RenderSettings& settings) {
    const Image image = render(std::move(scene), settings).image;
    Vec3<double> sum{};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            sum.x += double(image.at(x, y, 0)), sum.y += double(image.at(x, y, 1)),
                sum.z += double(image.at(x, y, 2));
    const double count = double(image.width) * image.height;
    return {sum.x / count, sum.y / count, sum.z / count};
}

Scene make_furnace(Mesh mesh, const Material& material) {
    Scene scene;
    add_object(scene, std::move(mesh), material);
    scene.environment = Environment{};
    scene.camera.from = {0.5f, 1, 4}, scene.camera.fov_degrees = 32;
    return scene;
}

/// A displaced body that does not fold, so that it has an inside, with automatic levels.
Scene make_displaced_furnace(const Material& material, float depth = 0.03f) {
    Scene scene = make_furnace(test::make_cube_sphere(3), material);
    scene.objects.back().displacement = 0;
    scene.displacements.push_back(
        test::make_displacement(test::make_random_map(64, 48, depth, 3), DisplacementSpace::object));
    return scene;
}

TEST(Glass, of_a_white_body_shows_its_surroundings_in_a_furnace_less_what_facets_keep) {
    for (const SphereNormals normals : {SphereNormals::facets, SphereNormals::smooth})
        for (const auto& [roughness, lost] :
             {std::pair(0.0f, 0.004), std::pair(0.1f, 0.006), std::pair(0.5f, 0.23)}) {
            const Mean mean = render_mean(make_furnace(make_sphere(12, normals), make_glass(roughness)),
                                          make_small_settings(24, 256, 64));
            const double noise = 4 * mean.standard_error;
            EXPECT_LE(mean.value, 1 + noise) << roughness;
            // Facets and smooth normals disagree about what is refracted above the surface.
            EXPECT_GE(mean.value, 1 - lost - (normals == SphereNormals::smooth ? 0.02 : 0.0) - noise)
                << roughness;
            EXPECT_LT(mean.standard_error, 0.01);
        }
}

TEST(Glass, of_a_displaced_white_body_gains_nothing_and_lets_no_path_go_astray) {
    for (const float roughness : {0.0f, 0.3f}) {
        RenderSettings settings = make_small_settings(24, 64, 64);
        settings.surface.pixel_error = 0.2f;
        const Image image = render(make_displaced_furnace(make_glass(roughness)), settings).image;
        const Mean mean = compute_covered_mean(image);
        EXPECT_LE(mean.value, 1 + 4 * mean.standard_error) << roughness;
        EXPECT_GE(mean.value, roughness > 0 ? 0.87 : 0.97) << roughness;
        for (const float value : image.pixels) ASSERT_TRUE(!std::isnan(value));
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) ASSERT_LT(image.at(x, y, 1), 2.5f);
    }
}

TEST(Glass, mixed_with_white_metal_shows_its_surroundings_in_a_furnace) {
    Material m = make_glass(0.05f);
    m.base_color = {1, 1, 1}, m.transmission_weight = 0.7f, m.metallic = 0.3f;
    for (const float diffuse : {0.0f, 1.0f}) {
        m.base_diffuse_roughness = diffuse;
        const Mean mean = render_mean(make_furnace(make_sphere(12, SphereNormals::facets), m),
                                      make_small_settings(24, 256, 64));
        EXPECT_NEAR(mean.value, 1, 0.015 + 4 * mean.standard_error) << diffuse;
    }
}

/// A box of that thickness that the camera looks through straight on, far from its sides.
Scene make_slab(float thickness, const Material& material) {
    Scene scene;
    const float h = 20, d = thickness;
    Mesh mesh;
    mesh.name = "slab";
    for (const float y : {0.0f, -d})
        for (const auto& [x, z] : {std::pair(-h, h), std::pair(h, h), std::pair(h, -h), std::pair(-h, -h)})
            mesh.positions.push_back({x, y, z});
    mesh.face_sizes.assign(6, 4);
    mesh.position_indices = {0, 1, 2, 3, 7, 6, 5, 4, 4, 5, 1, 0, 5, 6, 2, 1, 6, 7, 3, 2, 7, 4, 0, 3};
    add_object(scene, std::move(mesh), material);
    scene.environment = Environment{};
    scene.camera.from = {0, 5, 0}, scene.camera.to = {0, 0, 0}, scene.camera.up = {0, 0, 1};
    scene.camera.fov_degrees = 2;
    return scene;
}

/// Straight through a slab and back from it, between whose faces `left` of the light survives.
double see_slab(double left) {
    const double f = 0.04, passed = (1 - f) * (1 - f) * left / (1 - f * f * left * left);
    return f + passed * f * left + passed;
}

TEST(Glass, absorbs_along_a_slab_by_the_law_of_beer) {
    Material m = make_glass(0);
    m.transmission_color = {0.5f, 0.9f, 0.1f}, m.transmission_depth = 0.8f;
    for (const float thickness : {0.4f, 1.6f}) {
        const Vec3<double> seen = render_average(make_slab(thickness, m), make_small_settings(8, 512, 32));
        const double depths = double(thickness) / 0.8;
        EXPECT_NEAR(seen.x, see_slab(std::pow(0.5, depths)), 0.004) << thickness;
        EXPECT_NEAR(seen.y, see_slab(std::pow(0.9, depths)), 0.004) << thickness;
        EXPECT_NEAR(seen.z, see_slab(std::pow(0.1, depths)), 0.004) << thickness;
    }
}

TEST(Glass, without_a_depth_is_tinted_at_each_crossing) {
    Material m = make_glass(0);
    m.transmission_color = {0.5f, 0.9f, 0};
    const Vec3<double> seen = render_average(make_slab(1, m), make_small_settings(8, 512, 32));
    // Two crossings, and f of what is inside goes round once more.
    const auto expect = [](double c) { return 0.04 + 0.96 * 0.96 * c * c / (1 - 0.04 * 0.04) * 1.04; };
    EXPECT_NEAR(seen.x, expect(0.5), 0.004);
    EXPECT_NEAR(seen.y, expect(0.9), 0.004);
    EXPECT_NEAR(seen.z, 0.04, 0.002);
}

TEST(Glass, of_less_specular_weight_reflects_as_much_less) {
    Material m = make_glass(0);
    m.specular_weight = 0.25f;
    EXPECT_NEAR(scalar::refract_at(1, make_material_glass({m}).records[0].ior).reflected, 0.01, 1e-6);
    m.specular_weight = 0;
    EXPECT_EQ(make_material_glass({m}).records[0].ior, scalar::kLeastGlassIor);
}

/// A white ball in a body of clear glass: light gets in and out again.
TEST(Glass, around_a_white_ball_is_invisible_in_a_furnace) {
    Scene scene = make_furnace(make_sphere(12, SphereNormals::facets), make_glass(0.05f));
    add_object(scene, make_sphere(8, SphereNormals::facets), make_matte(1));
    scene.objects.back().world_from_object = make_scale({0.5f, 0.5f, 0.5f});
    const Mean mean = render_mean(std::move(scene), make_small_settings(16, 256, 200));
    EXPECT_NEAR(mean.value, 1, 0.03 + 4 * mean.standard_error);
}

/// Glow through coloured glass: of a ball at its middle, radius r, by the way of 1 - r along the radius.
TEST(Glass, colors_what_lies_in_it) {
    Material m = make_glass(0);
    m.transmission_color = {0.3f, 0.6f, 1}, m.transmission_depth = 1;
    Scene scene;
    add_object(scene, make_sphere(24, SphereNormals::smooth), m);
    Material glow = make_matte(0);
    glow.emission = {2.25f, 2.25f, 2.25f};
    add_object(scene, make_sphere(24, SphereNormals::smooth), glow);
    scene.objects.back().world_from_object = make_scale({0.5f, 0.5f, 0.5f});
    scene.camera.from = {0, 0, 30}, scene.camera.fov_degrees = 0.3f;
    const Vec3<double> seen = render_average(std::move(scene), make_small_settings(8, 512, 1));
    // Radiance is divided by the square of the ior on the way out, and 4 % stay inside.
    EXPECT_NEAR(seen.z, 0.96, 0.01);
    EXPECT_NEAR(seen.x / seen.z, std::pow(0.3, 0.5), 0.01);
    EXPECT_NEAR(seen.y / seen.z, std::pow(0.6, 0.5), 0.01);
}

/// A light in a slab over a black floor, which ends all rays that have missed it.
TEST(Glass, with_a_light_in_it_is_lit_alike_by_drawn_and_found_light) {
    Material m = make_glass(0.5f);
    m.transmission_color = {0.3f, 0.5f, 1}, m.transmission_depth = 0.5f;
    Scene scene = make_slab(2, m);
    add_object(scene, make_floor(19), make_matte(0));
    scene.objects.back().world_from_object.translation = {0, -1.5f, 0};
    scene.environment.reset();
    scene.lights = {{.type = LightType::point, .position = {0, -0.7f, 0}, .radius = 0.3f, .strength = 5}};
    scene.camera.fov_degrees = 10;
    const Vec3<double> drawn = render_average(scene, make_small_settings(16, 2048, 0));
    const Vec3<double> both = render_average(scene, make_small_settings(16, 2048, 1));
    EXPECT_GT(drawn.z, 0.1);
    EXPECT_LT(drawn.x, 0.8 * drawn.z);
    EXPECT_NEAR(both.x / drawn.x, 1, 0.015);
    EXPECT_NEAR(both.z / drawn.z, 1, 0.015);
}

TEST(ThinWalls, of_clear_glass_show_and_reflect_their_surroundings) {
    Scene scene = make_furnace(make_floor(50), make_wall({0.5f, 1, 0}));
    scene.camera = make_slab(1, {}).camera;
    const Vec3<double> seen = render_average(std::move(scene), make_small_settings(8, 1024, 8));
    EXPECT_NEAR(seen.x, see_slab(0.5), 0.006);
    EXPECT_NEAR(seen.y, 1, 1e-3);
    EXPECT_NEAR(seen.z, 0.04, 0.006);
}

/// A floor under sheets of that material, seen from beneath them.
double measure_floor(const std::vector<Material>& sheets, const Light& light, int bounces) {
    Scene scene;
    add_object(scene, make_floor(2), make_matte(0.5f));
    for (size_t k = 0; k < sheets.size(); ++k) {
        add_object(scene, make_floor(20), sheets[k]);
        scene.objects.back().world_from_object.translation = {0, 10 + float(k), 0};
    }
    scene.lights = {light};
    scene.camera.from = {0, 3, 3}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 20;
    return compute_covered_mean(render(std::move(scene), make_small_settings(8, 1024, bounces)).image).value;
}

TEST(ThinWalls, between_a_light_and_a_surface_take_their_part_of_it) {
    const Light sun{.type = LightType::sun, .direction = {0, -1, 0}, .angle_degrees = 0};
    const double bare = measure_floor({}, sun, 0);
    const double passed = 0.96 * 0.96 * 0.5 / (1 - 0.04 * 0.04 * 0.25), all = 0.96 / 1.04;
    EXPECT_NEAR(measure_floor({make_wall({1, 1, 1})}, sun, 0) / bare, all, 1e-4);
    EXPECT_NEAR(measure_floor({make_wall({1, 0.5f, 1})}, sun, 0) / bare, passed, 1e-4);
    EXPECT_NEAR(measure_floor({make_wall({1, 0.5f, 1}), make_wall({1, 1, 1})}, sun, 0) / bare, passed * all,
                1e-4);
    Material half = make_wall({1, 1, 1});
    half.opacity = 0.5f;
    EXPECT_NEAR(measure_floor({half}, sun, 0) / bare, 0.5 + 0.5 * all, 1e-4);
    EXPECT_EQ(measure_floor({make_glass(0)}, sun, 0), 0) << "a body stops rays to lights";
}

/// A large light partly before and partly behind a tinted wall: drawn alone, and by both ways.
TEST(ThinWalls, tint_alike_what_is_drawn_and_what_is_found) {
    Material wall = make_wall({1, 0.2f, 1});
    wall.ior = 1;
    const Light light{.type = LightType::point, .position = {0, 14, 0}, .radius = 6, .strength = 50};
    const double drawn = measure_floor({wall}, light, 0), both = measure_floor({wall}, light, 1);
    const double bare = measure_floor({}, light, 0);
    EXPECT_LT(drawn, 0.95 * bare);
    EXPECT_NEAR(both / drawn, 1, 0.01);
}

/// Rays to the environment and those that find it go through the wall alike.
TEST(ThinWalls, around_a_white_ball_are_invisible_in_a_furnace) {
    Scene scene = make_furnace(make_sphere(12, SphereNormals::facets), make_wall({1, 1, 1}));
    add_object(scene, make_sphere(8, SphereNormals::facets), make_matte(1));
    scene.objects.back().world_from_object = make_scale({0.6f, 0.6f, 0.6f});
    const Vec3<double> seen = render_average(std::move(scene), make_small_settings(16, 256, 100));
    EXPECT_NEAR(seen.y, 1, 0.004);
}

TEST(ThinWalls, that_are_rough_blur_and_lose_no_more_than_facets_do) {
    Material wall = make_wall({1, 1, 1});
    wall.roughness = 0.4f;
    const Mean mean = render_mean(make_furnace(make_sphere(12, SphereNormals::facets), wall),
                                  make_small_settings(24, 256, 64));
    EXPECT_LE(mean.value, 1 + 4 * mean.standard_error);
    EXPECT_GE(mean.value, 0.87);
}

/// From outside into a displaced body: the next surface is met from within, however near it is.
TEST(Glass, rays_that_enter_a_displaced_body_leave_it_from_within) {
    RenderSettings settings;
    settings.image.width = settings.image.height = 256;
    const cpu::Tracer tracer(prepare_scene(make_displaced_furnace(make_glass(0), 0.01f), settings), settings);
    constexpr size_t kCount = 200000;
    std::mt19937 generator(4);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3f{normal(generator), normal(generator), normal(generator)}; };
    std::vector<cpu::TraceRay> rays(kCount);
    for (cpu::TraceRay& ray : rays) {
        ray.origin = normalize(draw()) * 4.0f;
        ray.direction = normalize(draw() * 0.5f - ray.origin);
    }
    size_t left = 0;
    for (const bool is_inside : {false, true}) {
        std::vector<cpu::TraceHit> hits(rays.size());
        tracer.closest_hits(rays, hits);
        std::vector<cpu::TraceRay> next;
        for (size_t k = 0; k < hits.size(); ++k) {
            ASSERT_TRUE(hits[k].is_hit() || !is_inside) << "out of the body without a surface";
            if (!hits[k].is_hit()) continue;
            const cpu::SurfacePoint point = tracer.make_surface_point(hits[k]);
            const float height = dot(point.geometric_normal, rays[k].direction);
            ASSERT_TRUE(is_inside ? height >= 0 : height <= 0) << k;
            cpu::TraceRay ray = rays[k];
            ray.origin = tracer.offset_origin(point, ray.direction);
            if (std::fabs(height) > 1e-4f) next.push_back(ray);
        }
        left = next.size();
        rays = next;
    }
    EXPECT_GT(left, kCount / 2);
}

/// Of the bounces of these paths, those within the body see the surface that they entered, to the end. Few
/// others meet the body again, by whichever of two surfaces.
TEST(Glass, is_left_on_the_surface_that_it_was_entered_on) {
    const auto draw = [](BounceLevels levels) {
        RenderSettings settings = make_small_settings(32, 8, 1);
        settings.surface.pixel_error = 0.1f, settings.surface.bounce_levels = levels;
        return render(make_displaced_furnace(make_glass(0.7f)), settings).image;
    };
    const Image two_parts = draw(BounceLevels::automatic), one = draw(BounceLevels::camera);
    const size_t channels = one.channels.size();
    size_t different = 0;
    for (size_t k = 0; k < one.pixels.size(); k += channels)
        different += two_parts.pixels[k] == one.pixels[k] ? 0 : 1;
    EXPECT_LE(different, 4u) << "27 where bounces within it see two surfaces";
}

TEST(Glass, of_weight_zero_changes_no_bit) {
    Material plain = make_matte(0.7f), same = plain;
    plain.ior = same.ior = 1.5f;
    same.transmission_color = {0.1f, 0.2f, 0.3f}, same.transmission_depth = 2, same.is_thin_walled = true;
    const auto draw = [](const Material& material) {
        return render(make_displaced_furnace(material), make_small_settings(16, 4, 3)).image.pixels;
    };
    EXPECT_EQ(draw(same), draw(plain));
}

} // namespace
} // namespace relief
