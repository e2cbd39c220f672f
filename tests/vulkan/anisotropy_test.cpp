// Materials whose roughness has a direction: both engines agree.
#include "support/textured_materials.h"
#include "vulkan/both_engines.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

class AnisotropicPictures : public GpuTest {
  protected:
    /// Of the same random numbers; a path may go another way for a rounding.
    static void expect_agreement(const Material& material, bool is_displaced = false) {
        Scene scene;
        add_object(scene, make_uv_sphere(), material);
        if (is_displaced) {
            scene.objects.back().displacement = 0;
            scene.displacements.push_back(
                test::make_displacement(test::make_random_map(64, 48, 0.1f, 3), DisplacementSpace::tangent));
        }
        scene.objects.back().world_from_object =
            compose(make_rotation_degrees({20, 30, 40}), make_scale({-1, 0.8f, 0.9f}));
        add_object(scene, make_floor(4), make_matte(0.6f));
        scene.objects.back().world_from_object = make_translation({0, -1.1f, 0});
        add_lights(scene);
        scene.camera.from = {0, 1.5f, 5};
        expect_engines_agree(device(), std::move(scene), 8, {"diffuse_direct", "N", "variance"});
    }

    static Material make_brushed() {
        Material material = make_rich_material();
        material.specular_roughness_anisotropy = 0.8f, material.coat_roughness_anisotropy = 0.6f;
        return material;
    }
};

TEST_F(AnisotropicPictures, of_layers_agree) {
    expect_agreement(make_brushed());
    Material metal;
    metal.metallic = 1, metal.roughness = 0.4f, metal.specular_roughness_anisotropy = 0.9f;
    metal.textures = {make_input_texture(MaterialInput::roughness, {0.5f, 1, 0.8f, 0.7f})};
    expect_agreement(metal, true);
}

TEST_F(AnisotropicPictures, of_textured_inputs_and_normal_maps_agree) {
    Material material = make_brushed();
    material.textures = {make_input_texture(MaterialInput::roughness, {0.4f, 1, 0.7f, 0.9f}),
                         make_input_texture(MaterialInput::coat_roughness, {1, 0.5f}),
                         make_input_texture(MaterialInput::coat_color, {0.3f, 1})};
    set_input_texture(material, MaterialInput::normal, make_colors(7, 5, 1, 9));
    material.normal_scale = 0.3f;
    expect_agreement(material);
}

TEST_F(AnisotropicPictures, of_glass_agree) {
    Material glass;
    glass.transmission_weight = 0.8f, glass.roughness = 0.5f, glass.specular_roughness_anisotropy = 0.7f;
    expect_agreement(glass);
    glass.transmission_weight = 1, glass.is_thin_walled = true;
    expect_agreement(glass);
}

} // namespace
} // namespace relief::vulkan::tests
