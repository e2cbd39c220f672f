// Inputs of materials with textures: both engines agree within their noise.
#include "support/strides.h"
#include "support/textured_materials.h"
#include "support/z_test.h"
#include "vulkan/both_engines.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

class TexturedPictures : public GpuTest {
  protected:
    void expect_agreement(Scene scene, int spp) {
        expect_engines_agree(device(), std::move(scene), spp, {"albedo", "N", "variance"});
    }

    static Scene make_scene(const Material& material) {
        Scene scene;
        add_object(scene, make_uv_sphere(), material);
        add_object(scene, make_floor(4), make_matte(0.6f));
        scene.objects.back().world_from_object = make_translation({0, -1.1f, 0});
        add_lights(scene);
        scene.camera.from = {0, 1.5f, 5};
        return scene;
    }
};

TEST_F(TexturedPictures, of_layers_agree) {
    using enum MaterialInput;
    Material material = make_rich_material();
    for (const MaterialInput input : {coat_weight, coat_roughness, fuzz_weight, fuzz_roughness, base_weight,
                                      coat_color, coat_darkening, fuzz_color, specular_color, metallic})
        material.textures.push_back(make_input_texture(input, {0.2f, 0.9f, 0.6f, 0.4f}));
    material.textures[0].uv_scale = {3, 2}, material.textures[1].wrap = WrapMode::mirror;
    material.textures[2].uv_offset = {0.3f, -0.4f}, material.textures[2].filter = MapFilter::bspline;
    material.textures[3].wrap = WrapMode::black, material.textures[3].uv_scale = {1.5f, 1};
    material.textures[4].is_udim = true, material.textures[4].uv_scale = {2, 2};
    material.textures[4].tiles.push_back({1012, make_grey_texture({0.7f, 0.1f})});
    expect_agreement(make_scene(material), 8);
}

TEST_F(TexturedPictures, do_not_depend_on_how_many_values_a_texel_has) {
    const RenderSettings settings = make_small_settings(16, 2, 2);
    for (const uint32_t channels : {1u, 3u})
        for (const SampleType type : {SampleType::float16, SampleType::float32}) {
            const Scene wide = test::make_textured_torus(channels, type, MapFilter::none);
            const auto trace = [&](const Scene& scene) {
                return trace_picture(device(), *prepare_scene(scene, settings), settings).pixels;
            };
            EXPECT_TRUE(trace(test::make_narrow(wide)) == trace(wide)) << channels;
        }
}

TEST_F(TexturedPictures, of_glass_walls_agree) {
    Material wall;
    wall.transmission_weight = 0.9f, wall.is_thin_walled = true, wall.roughness = 0;
    wall.textures = {make_input_texture(MaterialInput::transmission_color, {0.2f, 0.9f, 0.6f, 0.4f}),
                     make_input_texture(MaterialInput::transmission_weight, {1, 0.5f}),
                     make_input_texture(MaterialInput::opacity, {1, 0.5f, 0.8f, 0.2f})};
    expect_agreement(make_scene(wall), 8);
    wall.is_thin_walled = false, wall.roughness = 0.2f;
    wall.textures.pop_back();
    expect_agreement(make_scene(wall), 8);
}

TEST_F(TexturedPictures, of_emitters_and_normal_maps_agree) {
    Material glowing;
    glowing.emission = {4, 3, 1};
    glowing.textures = {make_input_texture(MaterialInput::emission, {0.1f, 1, 0.5f, 0.3f}),
                        make_input_texture(MaterialInput::emission_luminance, {0.5f, 1})};
    Scene scene = make_scene(glowing);
    scene.lights.clear(), scene.environment.reset();
    Material bumpy = make_matte(0.7f);
    bumpy.textures = {{.input = MaterialInput::normal, .tiles = {{1001, make_colors(7, 5, 1, 9)}}}};
    bumpy.textures[0].uv_scale = {3, 3};
    scene.materials[1] = bumpy;
    expect_agreement(std::move(scene), 8);
}

} // namespace
} // namespace relief::vulkan::tests
