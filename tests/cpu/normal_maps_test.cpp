// Normal maps of materials, on plain and on displaced surfaces.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

constexpr uint32_t kTexels = 256;

using Field = std::function<float(float u, float v)>;

std::shared_ptr<Texture> make_texture(uint32_t side, const std::function<Vec3f(float, float)>& value) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = side, texture->channel_count = 3;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const Vec3f v = value((float(x) + 0.5f) / float(side), 1 - (float(y) + 0.5f) / float(side));
            texture->floats.insert(texture->floats.end(), {v.x, v.y, v.z, 1});
        }
    return texture;
}

std::shared_ptr<Texture> make_normal_texture(const Vec3f& direction) {
    const Vec3f n = normalize(direction);
    return make_texture(1, [&](float, float) { return (n + Vec3f{1, 1, 1}) * 0.5f; });
}

/// Of heights over a square of side 2 that (u, v) in [0, 1]^2 covers.
std::shared_ptr<Texture> make_slopes(const Field& height) {
    return make_texture(kTexels, [&](float u, float v) {
        const float d = 1e-3f;
        const float along_u = (height(u + d, v) - height(u - d, v)) / (4 * d);
        const float along_v = (height(u, v + d) - height(u, v - d)) / (4 * d);
        return (normalize(Vec3f{-along_u, -along_v, 1}) + Vec3f{1, 1, 1}) * 0.5f;
    });
}

Displacement make_heights(const Field& height) {
    Displacement map;
    map.type = DisplacementType::height;
    map.tiles.push_back({1001, make_texture(kTexels, [&](float u, float v) {
                             return Vec3f{1, 1, 1} * height(u, v);
                         })});
    return map;
}

Material make_mapped(std::shared_ptr<const Texture> texture) {
    Material material = make_matte(0.8f);
    set_input_texture(material, MaterialInput::normal, std::move(texture));
    return material;
}

/// A floor of side 2 seen from far above, lit by a sun without a disc; +x is right, +z down.
Scene make_mapped_floor(const Material& material) {
    Scene scene;
    add_object(scene, make_floor(1), material);
    scene.camera.from = {0, 20, 0}, scene.camera.up = {0, 0, -1};
    scene.camera.fov_degrees = 5;
    scene.lights.push_back(
        {.type = LightType::sun, .direction = {-1, -2, 0.7f}, .angle_degrees = 0, .strength = 2});
    return scene;
}

Image render_layers(Scene scene, int bounces = 0, int spp = 4, SurfaceMode mode = SurfaceMode::direct) {
    RenderSettings settings = make_small_settings(24, spp, bounces);
    settings.image.layers = {"N", "Ng"};
    settings.surface.level = 7;
    settings.surface.mode = mode;
    return render(std::move(scene), settings).image;
}

Vec3f get_vector(const Image& image, int x, int y, const std::string& prefix, const char* names) {
    const auto at = [&](size_t k) { return image.at(x, y, image.find_channel(prefix + names[k]).value()); };
    return {at(0), at(1), at(2)};
}

/// Calls visit(shading normal, colour, x, y) for pixels that are wholly covered.
template <class Visit> size_t visit_covered(const Image& image, const Visit& visit) {
    size_t count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (image.at(x, y, image.find_channel("A").value()) < 1) continue;
            visit(get_vector(image, x, y, "N.", "XYZ"), get_vector(image, x, y, "", "RGB"), x, y);
            ++count;
        }
    return count;
}

/// Every pixel has this normal, and the light that a matte floor reflects about it.
void expect_normal(const Image& image, const Vec3f& expected) {
    const Vec3f normal = normalize(expected);
    const double light =
        2 * 0.8 / std::numbers::pi * std::max(0.0f, dot(normal, normalize(Vec3f{1, 2, -0.7f})));
    EXPECT_GT(visit_covered(image,
                            [&](const Vec3f& n, const Vec3f& color, int, int) {
                                ASSERT_LT(length(n - normal), 2e-4f) << n.x << ' ' << n.y << ' ' << n.z;
                                ASSERT_NEAR(color.x, light, 1e-4);
                            }),
              300u);
}

TEST(NormalMaps, that_are_flat_or_have_scale_0_change_nothing) {
    Material plain = make_matte(0.8f), flat = make_mapped(make_normal_texture({0, 0, 1})),
             none = make_mapped(make_normal_texture({0.7f, -0.3f, 0.5f}));
    none.normal_scale = 0;
    const auto render_body = [](const Material& material, bool is_displaced) {
        Scene scene = make_mapped_floor(material);
        scene.objects.clear(), scene.meshes.clear(), scene.materials.clear();
        add_object(scene, test::make_torus(6, 9), material);
        scene.objects.back().world_from_object =
            compose(make_rotation_degrees({30, 20, 10}), make_scale({0.5f, 0.6f, -0.5f}));
        if (is_displaced) {
            scene.objects.back().displacement = 0;
            scene.displacements.push_back(
                test::make_displacement(test::make_random_map(64, 48, 0.1f, 3), DisplacementSpace::tangent));
        }
        return render_layers(std::move(scene));
    };
    for (const bool is_displaced : {false, true}) {
        const Image expected = render_body(plain, is_displaced);
        for (const Material& material : {flat, none}) {
            const Image found = render_body(material, is_displaced);
            for (size_t k = 0; k < expected.pixels.size(); ++k)
                ASSERT_NEAR(found.pixels[k], expected.pixels[k], 5e-6f) << is_displaced << ' ' << k;
        }
    }
}

TEST(NormalMaps, of_one_direction_tilt_a_plane_by_it) {
    const Vec3f n{0.3f, 0.2f, 0.9f}; // the floor's u is +x, its v is -z
    Scene scene = make_mapped_floor(make_mapped(make_normal_texture(n)));
    expect_normal(render_layers(scene), {n.x, n.z, -n.y});
    scene.materials[0].normal_flip_y = true;
    expect_normal(render_layers(scene), {n.x, n.z, n.y});
    scene.materials[0].normal_scale = 0.5f;
    expect_normal(render_layers(scene), {0.5f * n.x, n.z, 0.5f * n.y});
}

TEST(NormalMaps, follow_the_uvs_and_the_placing_of_an_object) {
    const Vec3f n{0.3f, 0.2f, 0.9f};
    const Scene floor = make_mapped_floor(make_mapped(make_normal_texture(n)));
    Scene scene = floor;
    scene.objects[0].world_from_object = make_scale({-1, 1, 1});
    expect_normal(render_layers(scene), {-n.x, n.z, -n.y});
    scene.objects[0].world_from_object = make_rotation_degrees({0, 90, 0}); // +x becomes -z, -z becomes -x
    expect_normal(render_layers(scene), {-n.y, n.z, -n.x});
    scene = floor;
    for (Vec2f& uv : scene.meshes[0].uvs) uv.y = 1 - uv.y; // mirrored
    expect_normal(render_layers(scene), {n.x, n.z, n.y});
    for (Vec2f& uv : scene.meshes[0].uvs) uv = {1 - uv.y, uv.x};
    expect_normal(render_layers(scene), {n.y, n.z, -n.x});
    scene = floor; // from below, so that the relief is seen from its back
    scene.objects[0].world_from_object = make_rotation_degrees({180, 0, 0});
    for (Light& light : scene.lights) light.strength = 0;
    scene.environment.reset();
    visit_covered(render_layers(scene), [&](const Vec3f& found, const Vec3f&, int, int) {
        ASSERT_LT(length(found - normalize(Vec3f{-n.x, n.z, -n.y})), 2e-4f);
    });
}

float bumps(float u, float v) {
    const float a = 2 * std::numbers::pi_v<float>;
    return 0.02f * std::sin(3 * a * u + 1) * std::sin(2 * a * v) + 0.01f * std::cos(a * (u + 2 * v));
}

float hills(float u, float v) { return 0.1f * std::sin(4 * u + 0.5f) * std::cos(3 * v) + 0.03f * u; }

/// Mean distance of the normals and of the colours, over pixels that both cover.
std::pair<double, double> measure_distances(const Image& a, const Image& b) {
    double normals = 0, colors = 0;
    const size_t count = visit_covered(a, [&](const Vec3f& n, const Vec3f& color, int x, int y) {
        normals += double(length(n - get_vector(b, x, y, "N.", "XYZ")));
        colors += double(length(color - get_vector(b, x, y, "", "RGB")));
    });
    return {normals / double(count), colors / double(count)};
}

TEST(NormalMaps, shade_bumps_as_a_height_map_of_them_does) {
    Scene displaced = make_mapped_floor(make_matte(0.8f));
    displaced.displacements.push_back(make_heights(bumps));
    displaced.objects[0].displacement = 0;
    const Image expected = render_layers(displaced);
    Scene mapped = make_mapped_floor(make_mapped(make_slopes(bumps)));
    const auto [normals, colors] = measure_distances(expected, render_layers(mapped));
    EXPECT_LT(normals, 0.01);
    EXPECT_LT(colors, 0.005);
    mapped.materials[0].normal_flip_y = true;
    EXPECT_GT(measure_distances(expected, render_layers(mapped)).first, 0.05);
}

TEST(NormalMaps, lie_on_top_of_a_displacement) {
    Scene whole = make_mapped_floor(make_matte(0.8f)), split = whole;
    whole.displacements.push_back(make_heights([](float u, float v) { return hills(u, v) + bumps(u, v); }));
    split.displacements.push_back(make_heights(hills));
    split.materials[0] = make_mapped(make_slopes(bumps));
    Scene coarse = split;
    coarse.materials[0] = make_matte(0.8f);
    for (Scene* scene : {&whole, &split, &coarse}) scene->objects[0].displacement = 0;
    const Image expected = render_layers(whole);
    const auto [normals, colors] = measure_distances(expected, render_layers(split));
    EXPECT_LT(normals, 0.02);
    EXPECT_LT(colors, 0.01);
    EXPECT_GT(measure_distances(expected, render_layers(coarse)).first, 0.1) << "the bumps are seen";
}

TEST(NormalMaps, are_the_same_on_a_tessellated_surface) {
    Scene scene = make_mapped_floor(make_mapped(make_normal_texture({0.4f, -0.5f, 0.8f})));
    scene.materials.back().normal_flip_y = true;
    scene.displacements.push_back(make_heights([](float u, float v) { return 3 * hills(u, v); }));
    scene.objects[0].displacement = 0;
    const Image direct = render_layers(scene);
    const Image tessellated = render_layers(scene, 0, 4, SurfaceMode::tessellated);
    EXPECT_LT(measure_distances(direct, tessellated).first, 2e-3);
}

/// A leaning surface: of a floor moved along its own normal and u, whose tangents a projection would lose.
TEST(NormalMaps, keep_their_frame_where_a_vector_map_folds_the_surface_over) {
    const auto turn = [](float u) { return 2.6f * u; }; // angle that u has climbed along a cylinder
    Displacement roll;
    roll.frame = FrameKind::mikk;
    roll.tiles.push_back({1001, make_texture(kTexels, [&](float u, float) {
                              const float r = 2 / 2.6f; // the floor is 2 long
                              return Vec3f{r * std::sin(turn(u)) - 2 * u, 0, r * (1 - std::cos(turn(u)))};
                          })});
    Scene scene = make_mapped_floor(make_mapped(make_normal_texture({0, 0.5f, 0.8f})));
    scene.displacements.push_back(roll);
    scene.objects[0].displacement = 0;
    scene.camera.from = {-20, 1, 0}, scene.camera.to = {0, 1, 0}, scene.camera.up = {0, 1, 0};
    // The tilt goes along v alone, which the roll leaves as it is: -z.
    const size_t count = visit_covered(render_layers(scene), [&](const Vec3f& n, const Vec3f&, int, int) {
        ASSERT_NEAR(std::fabs(n.z), 0.53f, 0.03f);
    });
    EXPECT_GT(count, 50u);
}

/// Normals of any direction in a white scene: pixels are as bright as the surroundings at most, and none is
/// black, not even where the map points away from the viewer or below the surface.
TEST(NormalMaps, in_a_furnace_add_no_light_and_make_no_black_pixels) {
    auto texture = test::make_random_map(64, 64, 1, 7);
    for (float& value : texture->floats) value = 0.5f + 0.5f * value;
    for (const float metallic : {0.0f, 1.0f}) {
        Material white = make_mapped(texture);
        white.base_color = {1, 1, 1}, white.metallic = metallic, white.roughness = 0.2f;
        Scene scene;
        add_object(scene, test::make_torus(12, 18), white);
        scene.environment = Environment{};
        scene.camera.from = {0.5f, 1.5f, 4};
        RenderSettings settings = make_small_settings(32, 256, 6);
        const Image image = render(std::move(scene), settings).image;
        const Mean mean = compute_covered_mean(image);
        EXPECT_GT(mean.pixels, 100u);
        EXPECT_LT(mean.value, 1 + 3 * mean.standard_error) << metallic;
        EXPECT_GT(mean.value, 0.55) << metallic;
        const size_t green = image.find_channel("G").value(), alpha = image.find_channel("A").value();
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (image.at(x, y, alpha) == 1) ASSERT_GT(image.at(x, y, green), 0.15f) << x << ' ' << y;
    }
}

/// The mirror direction of a viewer at a grazing angle would end below the floor.
TEST(NormalMaps, that_lean_away_from_the_viewer_still_reflect) {
    Material mirror = make_mapped(make_normal_texture({0, 0.9f, 0.3f}));
    mirror.base_color = {1, 1, 1}, mirror.metallic = 1, mirror.roughness = 0;
    Scene scene = make_mapped_floor(mirror);
    scene.lights.clear(), scene.environment = Environment{};
    scene.camera.from = {0, 5, 20};
    const size_t count = visit_covered(render_layers(scene, 1, 16), [](const Vec3f&, const Vec3f& color, int,
                                                                       int) { ASSERT_GT(color.x, 0.5f); });
    EXPECT_GT(count, 50u);
}

} // namespace
} // namespace relief
