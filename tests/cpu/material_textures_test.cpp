// Textures of materials multiply their numbers.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/shading/input_look_up.h"
#include "prepare/material_layers.h"
#include "scene/material_inputs.h"
#include "support/shading_scenes.h"
#include "support/textured_materials.h"

namespace relief {
namespace {

std::vector<float> render_pixels(const Material& material) {
    Scene scene;
    add_object(scene, make_sphere(12, SphereNormals::smooth), material);
    scene.environment = Environment{};
    scene.environment->color = {1, 0.5f, 0.25f};
    scene.camera.from = {0.5f, 1, 4};
    return render(std::move(scene), make_small_settings(16, 4, 2)).image.pixels;
}

void expect_factors(const Material& plain) {
    Material by_number = plain, by_texture = plain, unchanged = plain;
    by_number.metallic = 0.25f * plain.metallic, by_number.roughness = 0.5f * plain.roughness;
    by_texture.textures = {make_input_texture(MaterialInput::metallic, {0.25f}),
                           make_input_texture(MaterialInput::roughness, {0.5f})};
    EXPECT_EQ(render_pixels(by_texture), render_pixels(by_number));
    unchanged.textures = {make_input_texture(MaterialInput::metallic, {1})};
    EXPECT_EQ(render_pixels(unchanged), render_pixels(plain));
    EXPECT_NE(render_pixels(by_number), render_pixels(plain));
    Material beyond = plain;
    beyond.metallic = 1, beyond.textures = {make_input_texture(MaterialInput::metallic, {7})};
    Material whole = plain;
    whole.metallic = 1;
    EXPECT_EQ(render_pixels(beyond), render_pixels(whole)) << "limited to [0, 1]";
}

TEST(MaterialTextures, multiply_roughness_and_metallic) {
    Material metal;
    metal.base_color = {0.9f, 0.6f, 0.3f}, metal.metallic = 1, metal.roughness = 0.5f;
    expect_factors(metal);
}

TEST(MaterialTextures, multiply_the_metallic_of_a_base_under_layers) {
    Material coated;
    coated.base_color = {0.9f, 0.6f, 0.3f}, coated.metallic = 1, coated.coat_weight = 0.5f;
    Material by_number = coated, by_texture = coated;
    by_number.metallic = 0.25f;
    by_texture.textures = {make_input_texture(MaterialInput::metallic, {0.25f})};
    EXPECT_EQ(render_pixels(by_texture), render_pixels(by_number));
    EXPECT_NE(render_pixels(by_number), render_pixels(coated));
}

/// A body with places on textures, a floor that it lights, and an environment.
Scene make_input_scene(const Material& material) {
    Scene scene;
    add_object(scene, make_uv_sphere(), material);
    add_object(scene, make_floor(3), make_matte(0.5f));
    scene.objects.back().world_from_object.translation = {0, -1, 0};
    scene.environment = Environment{};
    scene.environment->color = {1, 0.5f, 0.25f};
    scene.camera.from = {0.5f, 1, 4};
    return scene;
}

std::vector<float> render_inputs(const Material& material, int spp = 4) {
    RenderSettings settings = make_small_settings(16, spp, 3);
    settings.image.layers = {"albedo", "N"};
    return render(make_input_scene(material), settings).image.pixels;
}

float find_difference(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    float most = 0;
    for (size_t k = 0; k < a.size(); ++k)
        most = std::max(most, std::fabs(a[k] - b[k]) / std::max(1.0f, std::fabs(b[k])));
    return most;
}

/// Every input in its turn: its number, or a texture of one value, or of two.
void expect_texture_is_number(const Material& usual, MaterialInput input) {
    const MaterialInputKind& kind = get_input_kind(input);
    SCOPED_TRACE(kind.name);
    Material by_number = usual, by_texture = usual, by_two = usual;
    const float value = 0.5f;
    if (kind.number) by_number.*kind.number *= value;
    if (kind.color) by_number.*kind.color = usual.*kind.color * value;
    by_texture.textures.push_back(make_input_texture(input, {value}));
    by_two.textures.push_back(make_input_texture(input, {value, 0.9f, 0.2f, value}));
    const std::vector<float> expected = render_inputs(by_number);
    EXPECT_LE(find_difference(render_inputs(by_texture), expected), 2e-6f);
    EXPECT_GT(find_difference(render_inputs(by_two), expected), 1e-3f);
    EXPECT_GT(find_difference(render_inputs(usual), expected), 1e-3f);
}

TEST(MaterialTextures, of_one_value_are_that_number_for_every_input_of_an_opaque_material) {
    for (const MaterialInputKind& kind : list_material_inputs()) {
        if (kind.input == MaterialInput::normal || kind.input == MaterialInput::opacity ||
            kind.input == MaterialInput::transmission_weight ||
            kind.input == MaterialInput::transmission_color)
            continue;
        Material material = make_rich_material();
        if (kind.color == &Material::emission) material.emission = {3, 2, 1};
        expect_texture_is_number(material, kind.input);
    }
}

TEST(MaterialTextures, of_one_value_are_that_number_for_glass_and_cut_outs) {
    for (const bool is_thin : {false, true})
        for (const float roughness : {0.01f, 0.3f}) {
            Material glass;
            glass.transmission_weight = 0.9f, glass.transmission_color = {0.9f, 0.8f, 0.4f};
            glass.roughness = roughness, glass.is_thin_walled = is_thin,
            glass.specular_color = {0.9f, 0.8f, 1};
            expect_texture_is_number(glass, MaterialInput::transmission_weight);
            expect_texture_is_number(glass, MaterialInput::transmission_color);
            expect_texture_is_number(glass, MaterialInput::specular_color);
            glass.metallic = 0.6f;
            expect_texture_is_number(glass, MaterialInput::metallic);
        }
    expect_texture_is_number(make_matte(0.8f), MaterialInput::opacity);
}

TEST(MaterialTextures, make_numbers_of_vertices_only_beyond_what_points_have) {
    using enum MaterialInput;
    const std::set<MaterialInput> of_points = {base_color, roughness, metallic, opacity, normal};
    for (const MaterialInputKind& kind : list_material_inputs()) {
        Material material = make_rich_material();
        material.textures = {make_input_texture(kind.input, {0.5f, 1})};
        const TexturedMaterials made = make_textured_materials({Material(), material});
        EXPECT_EQ(made.has_vertex_numbers, !of_points.contains(kind.input)) << kind.name;
        EXPECT_EQ(made.find(0), nullptr);
        EXPECT_EQ(made.find(1)->places, 1u << find_input_place(kind.input).first) << kind.name;
    }
}

TEST(MaterialTextures, of_points_come_first) {
    Material material;
    for (const MaterialInput input : {MaterialInput::base_weight, MaterialInput::roughness,
                                      MaterialInput::opacity, MaterialInput::base_color})
        material.textures.push_back(make_input_texture(input, {0.5f}));
    const TexturedMaterials made = make_textured_materials({material});
    const TexturedMaterial& found = made.list.at(0);
    EXPECT_EQ(found.point_count, 2u);
    const uint32_t expected[] = {scalar::kInputRoughness, scalar::kInputBaseColor, scalar::kInputBaseColor,
                                 scalar::kInputOpacity};
    for (size_t k = 0; k < 4; ++k) EXPECT_EQ(found.textures.at(k).place.first, expected[k]) << k;
    EXPECT_EQ(found.places, scalar::kColorPlace | scalar::kOpacityPlace | 1u << scalar::kInputRoughness);
}

float find_opacity_at(const InputTexture& texture, const Vec2f& uv) {
    Material material;
    material.textures = {texture};
    const TexturedMaterials made = make_textured_materials({material});
    const Surface surface;
    const scalar::InputNumbers found = cpu::find_inputs(made.list.at(0).textures, scalar::kOpacityPlace,
                                                        made.list.at(0).numbers, {surface, 0, {}, uv});
    return found.word[scalar::kInputOpacity];
}

TEST(MaterialTextures, lie_where_scale_offset_wrap_and_tiles_put_them) {
    // From the top left: the centres of texels are at 1/4 and 3/4.
    InputTexture texture = make_input_texture(MaterialInput::opacity, {0.1f, 0.2f, 0.3f, 0.4f});
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {0.25f, 0.75f}), 0.1f);
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {1.75f, -0.75f}), 0.4f) << "repeats";
    texture.uv_scale = {2, -1}, texture.uv_offset = {-0.25f, 1.5f};
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {0.25f, 0.25f}), 0.3f);
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {0.5f, 0.75f}), 0.2f);
    texture.uv_scale = {1, 1}, texture.uv_offset = {0, 0};
    for (const MapFilter filter : {MapFilter::none, MapFilter::bspline}) {
        texture.filter = filter;
        texture.wrap = WrapMode::clamp;
        EXPECT_FLOAT_EQ(find_opacity_at(texture, {7, -3}), 0.4f);
        texture.wrap = WrapMode::black;
        EXPECT_EQ(find_opacity_at(texture, {7, -3}), 0);
    }
    texture.filter = MapFilter::none;
    texture.wrap = WrapMode::mirror;
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {1.75f, 0.75f}), 0.1f);
    texture.is_udim = true, texture.wrap = WrapMode::repeat;
    texture.tiles = {{1002, make_grey_texture({0.6f})}, {1011, make_grey_texture({0.7f, 0.5f})}};
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {1.5f, 0.5f}), 0.6f);
    EXPECT_FLOAT_EQ(find_opacity_at(texture, {0.99f, 1.5f}), 0.5f) << "a tile ends with its own texels";
    for (const Vec2f& outside : {Vec2f{0.5f, 0.5f}, {-0.5f, 1.5f}, {10.5f, 0.5f}, {1e30f, 0.5f}, {0.5f, -1}})
        EXPECT_EQ(find_opacity_at(texture, outside), 1) << "the number alone";
}

/// What layers leave over is tabled over the numbers with textures: light is neither made nor lost.
TEST(MaterialTextures, on_layers_keep_a_white_furnace_white) {
    using enum MaterialInput;
    const std::vector<std::vector<MaterialInput>> sets = {
        {coat_weight},
        {fuzz_weight, fuzz_roughness},
        {coat_weight, coat_roughness, roughness},
        {specular_weight, base_diffuse_roughness},
        {coat_weight, coat_roughness, fuzz_weight, roughness}};
    for (const std::vector<MaterialInput>& inputs : sets) {
        Material white = make_rich_material();
        white.base_color = white.specular_color = white.coat_color = white.fuzz_color = {1, 1, 1};
        white.roughness = 0.8f, white.specular_weight = 1;
        // specular_weight takes light from a metal.
        white.metallic = inputs.front() == specular_weight ? 0.0f : 0.5f;
        for (const MaterialInput input : inputs)
            white.textures.push_back(make_input_texture(input, {0.1f, 0.9f, 0.5f, 0.3f}));
        Scene scene = make_input_scene(white);
        scene.objects.pop_back(), scene.environment->color = {1, 1, 1};
        const Mean mean =
            compute_covered_mean(render(std::move(scene), make_small_settings(24, 64, 4)).image);
        EXPECT_GT(mean.pixels, 100u);
        EXPECT_NEAR(mean.value, 1, 0.006 + 4 * mean.standard_error) << get_input_name(inputs.front());
        EXPECT_LT(mean.standard_error, 0.004);
    }
}

TEST(MaterialTextures, of_one_value_need_no_more_rows_of_albedos) {
    Material material = make_rich_material();
    material.textures = {make_input_texture(MaterialInput::coat_weight, {0.5f}),
                         make_input_texture(MaterialInput::fuzz_color, {0.5f, 1, 0, 0.2f})};
    const auto count_rows = [&] {
        return make_material_layers({material}, make_textured_materials({material})).grids.at(0).row_count;
    };
    EXPECT_EQ(count_rows(), 1u);
    material.textures[0] = make_input_texture(MaterialInput::coat_weight, {0.5f, 1});
    EXPECT_EQ(count_rows(), 17u);
    material.textures.push_back(make_input_texture(MaterialInput::fuzz_weight, {0.5f, 1}));
    EXPECT_EQ(count_rows(), 81u);
    material.textures = {make_input_texture(MaterialInput::roughness, {0.5f})};
    EXPECT_EQ(count_rows(), 1u);
    material.textures = {make_input_texture(MaterialInput::roughness, {0.5f, 1})};
    EXPECT_EQ(count_rows(), 16u);
}

} // namespace
} // namespace relief
