// Colours of textures and directions to suns for many points at once, beside one by one.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/shading/point_material.h"
#include "cpu/shading/shading_kernels.h"
#include "cpu/shading/textures.h"
#include "formulas/basis.h"
#include "formulas/light_source.h"
#include "formulas/path.h"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "support/bodies.h"
#include "support/hashed_texels.h"
#include "support/strides.h"

namespace relief {
namespace {

constexpr size_t kMany = 150; ///< several rounds of four times sixteen, the last one not full

/// At texels' centres, between them, at the border and far outside.
std::vector<Vec2f> make_uvs() {
    std::vector<Vec2f> uvs{{0, 0},           {1, 1},         {0.5f, 0.5f}, {-1e-9f, 1 + 1e-6f},
                           {-3.25f, 17.75f}, {1e30f, -1e30f}};
    for (uint32_t k = 0; uvs.size() < kMany; ++k)
        uvs.push_back(scalar::sobol_pair(3, k, 0) * 3.0f - Vec2f{1, 1});
    return uvs;
}

/// Halves of all kinds: negative and subnormal ones, the greatest, infinities and NaN.
Texture make_all_halves() {
    Texture texture;
    texture.width = 256, texture.height = 64, texture.channel_count = 4;
    for (uint32_t k = 0; k < 0x10000; ++k) texture.halves.push_back(uint16_t(k * 40503));
    return texture;
}

/// NaN have no sign nor payload that would have to be the same.
bool is_same(const Vec3f& a, const Vec3f& b) {
    const auto is_same_number = [](float x, float y) {
        return (std::isnan(x) && std::isnan(y)) || std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
    };
    return is_same_number(a.x, b.x) && is_same_number(a.y, b.y) && is_same_number(a.z, b.z);
}

void expect_same_colors(const Texture& texture) {
    const std::vector<Vec2f> uvs = make_uvs();
    for (const std::string& isa : available_isas())
        for (const size_t count : {size_t(1), size_t(16), size_t(37), kMany}) {
            std::vector<Vec3f> colors(count);
            cpu::find_shading_kernels(isa.c_str()).fetch_texture(texture, uvs.data(), count, colors.data());
            for (size_t k = 0; k < count; ++k)
                ASSERT_TRUE(is_same(colors[k], cpu::fetch_texture(texture, uvs[k])))
                    << isa << ", number " << k;
        }
}

TEST(TextureKernels, find_for_many_points_the_colours_of_each) {
    for (const bool has_halves : {false, true})
        for (const uint32_t width : {1u, 2u, 7u, 300u})
            for (const uint32_t channels : {1u, 2u, 3u, 4u}) {
                const auto texture = test::make_hashed_texture(width, 1 + width / 2, channels, has_halves);
                expect_same_colors(*texture);
                if (channels == 1 || channels == 3) expect_same_colors(test::make_narrow(*texture, channels));
                if (HasFatalFailure()) return;
            }
}

TEST(TextureKernels, take_halves_of_all_kinds_as_they_are) {
    const Texture texture = make_all_halves();
    std::vector<Vec2f> centres;
    for (uint32_t k = 0; k < texture.width * texture.height; ++k)
        centres.push_back({(float(k % 256) + 0.5f) / 256, 1 - (float(k / 256) + 0.5f) / 64});
    for (const std::string& isa : available_isas()) {
        std::vector<Vec3f> colors(centres.size());
        cpu::find_shading_kernels(isa.c_str())
            .fetch_texture(texture, centres.data(), centres.size(), colors.data());
        for (size_t k = 0; k < centres.size(); ++k)
            ASSERT_TRUE(is_same(colors[k], cpu::fetch_texture(texture, centres[k])))
                << isa << ", texel " << k;
    }
}

TEST(ConeKernels, draw_for_many_points_the_directions_of_each) {
    std::vector<Vec2f> u{{0, 0}, {0.99999994f, 0.99999994f}};
    for (uint32_t k = 0; u.size() < kMany; ++k) u.push_back(scalar::sobol_pair(5, k, 0));
    for (const float cone : {1e-12f, 1e-5f, 0.3f, 1.0f}) {
        scalar::LightSourceData sun{};
        sun.kind = scalar::kSourceSun, sun.color = {1, 0.5f, 2}, sun.strength = 3, sun.cone = cone;
        sun.basis = scalar::make_basis(normalize(Vec3f{0.3f, -0.8f, -0.2f}));
        for (const std::string& isa : available_isas())
            for (const size_t count : {size_t(1), size_t(16), size_t(37), kMany}) {
                std::vector<Vec3f> directions(count);
                cpu::find_shading_kernels(isa.c_str())
                    .draw_cone(sun.basis, sun.cone, u.data(), count, directions.data());
                for (size_t k = 0; k < count; ++k)
                    ASSERT_TRUE(is_same(directions[k], scalar::draw_sun(sun, u[k]).direction))
                        << isa << ", number " << k;
            }
    }
}

/// An object for each of some materials: plain, with a texture of a colour (two share one), of a colour that
/// is a B-spline, of numbers, and of both; with a coat; of glass; of a colour with a scale and an offset,
/// and of one that is mirrored.
Scene make_materials() {
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(2),
        test::make_displacement(test::make_hashed_texture(4, 4, 3, false), DisplacementSpace::object));
    const auto first = test::make_hashed_texture(7, 5, 3, true),
               second = test::make_hashed_texture(64, 32, 1, false);
    scene.materials.resize(11);
    for (size_t k = 0; k < scene.materials.size(); ++k) {
        const float number = float(k + 1) / 12;
        scene.materials[k].base_color = {number, 1 - number, 0.5f};
        scene.materials[k].roughness = number, scene.materials[k].metallic = 1 - number;
        scene.materials[k].ior = 1 + number, scene.materials[k].emission = {number, 0, 0};
    }
    const auto set = [&](size_t k, MaterialInput input, const auto& texture) {
        set_input_texture(scene.materials[k], input, texture);
    };
    for (const size_t k : {1, 2, 4, 8, 9, 10}) set(k, MaterialInput::base_color, first);
    set(3, MaterialInput::base_color, second);
    scene.materials[4].textures[0].filter = MapFilter::bspline;
    set(5, MaterialInput::metallic, second), set(5, MaterialInput::roughness, second);
    scene.materials[6] = scene.materials[5], set(6, MaterialInput::base_color, first);
    scene.materials[7].coat_weight = 0.5f;
    scene.materials[8].transmission_weight = 1;
    scene.materials[9].textures[0].uv_scale = {3, -2}, scene.materials[9].textures[0].uv_offset = {0.25f, 7};
    scene.materials[10].textures[0].wrap = WrapMode::mirror;
    const Object object = scene.objects[0];
    scene.objects.clear();
    for (uint32_t k = 0; k < scene.materials.size(); ++k) {
        scene.objects.push_back(object);
        scene.objects.back().material = k;
    }
    return scene;
}

/// Without make_point_materials.
cpu::PointMaterial find_material(const PreparedScene& scene, uint32_t instance, const Vec2f& uv) {
    const uint32_t index = scene.instances[instance].material;
    const Material& material = scene.materials[index];
    const uint32_t glass = scene.glass.record_of_material[index];
    cpu::PointMaterial m{material.base_color,
                         material.emission,
                         material.roughness,
                         material.metallic,
                         material.ior,
                         scene.layers.record_of_material[index],
                         glass,
                         glass};
    const auto fetch = [&](MaterialInput input) {
        const InputTexture* texture = find_input_texture(material, input);
        if (!texture) return Vec3f{1, 1, 1};
        const Vec2f scale = texture->uv_scale, offset = texture->uv_offset;
        const Vec2f at{uv.x * scale.x + offset.x, uv.y * scale.y + offset.y};
        const Texture& texels = *texture->tiles[0].texture;
        return texture->wrap == WrapMode::repeat
                   ? cpu::fetch_texture(texels, texture->filter, at)
                   : cpu::fetch_wrapped(texels, texture->filter, texture->wrap, at);
    };
    m.base_color = m.base_color * fetch(MaterialInput::base_color);
    m.roughness *= fetch(MaterialInput::roughness).x;
    m.metallic *= fetch(MaterialInput::metallic).x;
    m.base_color = scalar::limit_color(m.base_color);
    m.roughness = std::clamp(m.roughness, 0.0f, 1.0f), m.metallic = std::clamp(m.metallic, 0.0f, 1.0f);
    return m;
}

TEST(PointMaterials, are_found_for_many_hits_as_for_each) {
    const RenderSettings settings;
    const auto scene = prepare_scene(make_materials(), settings);
    ASSERT_FALSE(scene->layers.empty() || scene->glass.empty());
    const std::vector<Vec2f> uvs = make_uvs();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<cpu::TraceHit> hits(kMany);
    std::vector<cpu::SurfacePoint> points(kMany);
    for (uint32_t k = 0; k < kMany; ++k) {
        hits[k].instance = scalar::hash_uint(k / 3) % uint32_t(scene->instances.size()); // three in a row
        points[k].uv = k % 29 == 0 ? Vec2f{nan, 0} : uvs[k];
    }
    for (const std::string& isa : available_isas()) {
        std::vector<cpu::PointMaterial> found(kMany);
        cpu::make_point_materials(*scene, cpu::find_shading_kernels(isa.c_str()), hits, points, found,
                                  cpu::BaseColor::with_texture);
        for (size_t k = 0; k < kMany; ++k) {
            const cpu::PointMaterial one = find_material(*scene, hits[k].instance, points[k].uv);
            ASSERT_EQ(found[k].base_color, one.base_color) << isa << ", number " << k;
            ASSERT_EQ(found[k].emission, one.emission) << k;
            ASSERT_EQ(found[k].roughness, one.roughness) << k;
            ASSERT_EQ(found[k].metallic, one.metallic) << k;
            ASSERT_EQ(found[k].ior, one.ior) << k;
            ASSERT_EQ(found[k].layers, one.layers) << k;
            ASSERT_EQ(found[k].glass, one.glass) << k;
            ASSERT_EQ(found[k].glass_numbers, one.glass_numbers) << k;
        }
    }
}

TEST(PointMaterials, leave_textures_of_base_colours_out_where_nobody_asks) {
    const RenderSettings settings;
    const auto scene = prepare_scene(make_materials(), settings);
    std::vector<cpu::TraceHit> hits(scene->instances.size());
    for (uint32_t k = 0; k < hits.size(); ++k) hits[k].instance = k;
    const std::vector<cpu::SurfacePoint> points(hits.size());
    std::vector<cpu::PointMaterial> found(hits.size());
    cpu::make_point_materials(*scene, cpu::find_shading_kernels(available_isas()[0].c_str()), hits, points,
                              found, cpu::BaseColor::factor_alone);
    for (uint32_t k = 0; k < hits.size(); ++k) {
        const Material& material = scene->materials[scene->instances[k].material];
        EXPECT_EQ(found[k].base_color, material.base_color) << k;
        EXPECT_EQ(found[k].emission, material.emission) << k;
    }
}

} // namespace
} // namespace relief
