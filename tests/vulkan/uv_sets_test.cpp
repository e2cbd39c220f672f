// Textures on another uv set than that of their mesh: both engines agree within their noise.
#include "support/uv_sets.h"
#include "vulkan/both_engines.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

class UvSetPictures : public GpuTest {
  protected:
    static std::vector<float> render_pixels(Scene scene) {
        RenderSettings settings = make_small_settings(16, 2, 3);
        settings.image.layers = {"albedo"};
        settings.device.engine = EngineKind::vulkan;
        return render(std::move(scene), settings).image.pixels;
    }
};

TEST_F(UvSetPictures, agree) {
    for (const bool has_triangles : {false, true})
        for (const Material& material : make_set_materials()) {
            Scene scene =
                make_set_scene(make_two_set_sphere(has_triangles), put_on_set(material, kFurtherSet));
            expect_engines_agree(device(), std::move(scene), 8, {"albedo", "variance"});
        }
}

TEST_F(UvSetPictures, are_those_of_a_mesh_whose_sets_are_exchanged) {
    const Mesh mesh = make_two_set_sphere();
    for (const Material& material : make_set_materials()) {
        const auto further = render_pixels(make_set_scene(mesh, put_on_set(material, kFurtherSet)));
        EXPECT_EQ(further, render_pixels(make_set_scene(exchange_sets(mesh), material)));
        EXPECT_NE(further, render_pixels(make_set_scene(mesh, material)));
    }
}

/// Sets of one number are further ones of a mesh and the own one of another, which has further ones as well.
TEST_F(UvSetPictures, of_several_meshes_agree) {
    const Material material = make_set_materials()[0];
    Scene scene = make_set_scene(make_two_set_sphere(), put_on_set(material, kFurtherSet));
    Mesh other = make_two_set_sphere(true);
    other.uv_set = kFurtherSet, other.further_uvs[0].number = 5;
    Material mixed = put_on_set(material, 5);
    mixed.textures[0].uv_set = kFurtherSet;
    add_object(scene, other, mixed);
    scene.objects.back().world_from_object = make_translation({1.2f, 0.5f, 0});
    add_object(scene, make_uv_sphere(), material);
    scene.objects.back().world_from_object = make_translation({-1.2f, 0.5f, 0});
    expect_engines_agree(device(), std::move(scene), 8, {"albedo", "variance"});
}

TEST_F(UvSetPictures, of_tiles_on_surfaces_with_tiles_agree) {
    for (const int uv_set : {kOwnUvSet, 0}) {
        Scene scene = make_tiled_scene();
        scene.materials[0].textures[0].uv_set = uv_set;
        expect_engines_agree(device(), std::move(scene), 8, {"albedo", "variance"});
    }
}

} // namespace
} // namespace relief::vulkan::tests
