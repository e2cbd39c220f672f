// Inputs of materials with textures: both engines agree within their noise.
#include "cpu/cpu_engine.h"
#include "support/textured_materials.h"
#include "support/z_test.h"
#include "vulkan/path_tracer.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

class TexturedPictures : public GpuTest {
  protected:
    void expect_agreement(Scene scene, int spp) {
        RenderSettings settings = make_small_settings(16, spp, 4);
        settings.image.layers = {"albedo", "N", "variance"};
        const auto prepared = prepare_scene(std::move(scene), settings);
        const DeviceScene device_scene(device(), *prepared);
        Tracer tracer(device(), *prepared, device_scene, settings, {.ray_capacity = 4096});
        PathTracer path_tracer(tracer, settings);
        Film film(16, 16, settings.image.crop, settings.image.layers);
        const PixelRange range{film.window(), 0, 16 * 16};
        path_tracer.trace_samples(film, {&range, 1}, {0, spp});
        Film same(16, 16, settings.image.crop, settings.image.layers);
        make_cpu_engine(prepared, settings)->render(same, nullptr);
        expect_close(film.resolve(), same.resolve());
    }

    /// Of the same random numbers; a path may go another way for a rounding.
    static void expect_close(const Image& found, const Image& expected) {
        ASSERT_EQ(found.pixels.size(), expected.pixels.size());
        size_t apart = 0;
        double sum = 0, expected_sum = 0;
        for (size_t k = 0; k < found.pixels.size(); ++k) {
            const float wanted = expected.pixels[k];
            if (std::fabs(found.pixels[k] - wanted) > 2e-3f * std::max(1.0f, std::fabs(wanted))) ++apart;
            sum += double(found.pixels[k]), expected_sum += double(wanted);
        }
        EXPECT_LT(apart, found.pixels.size() / 20);
        EXPECT_NEAR(sum, expected_sum, 0.01 * std::fabs(expected_sum));
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
