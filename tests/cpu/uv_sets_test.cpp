// Textures on another uv set than that of their mesh: as if the sets were exchanged.
#include <gtest/gtest.h>

#include "relief/session.h"
#include "support/uv_sets.h"

namespace relief {
namespace {

std::vector<float> render_set_pixels(Scene scene, SurfaceMode mode = SurfaceMode::direct) {
    RenderSettings settings = make_small_settings(24, 4, 3);
    settings.image.layers = {"depth", "albedo", "N"};
    settings.surface.mode = mode;
    if (mode == SurfaceMode::tessellated) settings.surface.level = 2;
    return render(std::move(scene), settings).image.pixels;
}

void expect_exchanged(const Mesh& mesh) {
    const std::vector<Material> materials = make_set_materials();
    for (size_t k = 0; k < materials.size(); ++k) {
        SCOPED_TRACE(k);
        const auto further = render_set_pixels(make_set_scene(mesh, put_on_set(materials[k], kFurtherSet)));
        EXPECT_EQ(further, render_set_pixels(make_set_scene(exchange_sets(mesh), materials[k])));
        EXPECT_NE(further, render_set_pixels(make_set_scene(mesh, materials[k])));
    }
}

TEST(UvSets, make_the_picture_of_a_mesh_whose_sets_are_exchanged) { expect_exchanged(make_two_set_sphere()); }

TEST(UvSets, are_linear_on_triangles) { expect_exchanged(make_two_set_sphere(true)); }

TEST(UvSets, follow_subdivision) {
    Mesh mesh = make_two_set_sphere();
    // Corners of one place become one point.
    for (Vec3f& p : mesh.positions)
        p = {std::round(p.x * 4096) / 4096, std::round(p.y * 4096) / 4096, std::round(p.z * 4096) / 4096};
    mesh.normals.clear(), mesh.normal_indices.clear();
    mesh.subdivision = {.scheme = SubdivisionScheme::catmark, .level = 1};
    expect_exchanged(mesh);
}

TEST(UvSets, named_by_the_number_of_the_own_one_are_that) {
    Mesh mesh = make_two_set_sphere();
    const Material material = make_set_materials()[0];
    const auto expected = render_set_pixels(make_set_scene(mesh, material));
    EXPECT_EQ(render_set_pixels(make_set_scene(mesh, put_on_set(material, 0))), expected);
    mesh.uv_set = 7;
    EXPECT_EQ(render_set_pixels(make_set_scene(mesh, put_on_set(material, 7))), expected);
    Material both = put_on_set(material, kFurtherSet), named = both;
    both.textures[0].uv_set = kOwnUvSet, named.textures[0].uv_set = 7;
    EXPECT_EQ(render_set_pixels(make_set_scene(mesh, named)), render_set_pixels(make_set_scene(mesh, both)));
}

/// Displacement goes by the mesh's own uvs: only textures move with the set.
Scene make_displaced_scene(const Mesh& mesh, const Material& material) {
    Scene scene = make_set_scene(mesh, material);
    Displacement map;
    map.tiles = {{1001, make_grey_texture({0.05f, 0.2f, 0.1f, 0})}};
    map.type = DisplacementType::height;
    scene.displacements = {map};
    scene.objects[0].displacement = 0;
    return scene;
}

TEST(UvSets, lie_on_displaced_surfaces_of_both_kinds) {
    const Material material = make_set_materials()[0];
    const Material further = put_on_set(material, kFurtherSet);
    Mesh mesh = make_two_set_sphere(), same = mesh;
    same.further_uvs[0].uvs = same.uvs;
    for (const SurfaceMode mode : {SurfaceMode::direct, SurfaceMode::tessellated}) {
        const auto expected = render_set_pixels(make_displaced_scene(mesh, material), mode);
        EXPECT_EQ(render_set_pixels(make_displaced_scene(same, further), mode), expected);
        EXPECT_NE(render_set_pixels(make_displaced_scene(mesh, further), mode), expected);
    }
}

TEST(UvSets, with_tiles_are_whole_on_surfaces_that_a_map_with_tiles_displaces) {
    for (const int uv_set : {kOwnUvSet, 0})
        for (const SurfaceMode mode : {SurfaceMode::direct, SurfaceMode::tessellated}) {
            Scene scene = make_tiled_scene();
            scene.materials[0].textures[0].uv_set = uv_set;
            RenderSettings settings = make_small_settings(16, 1, 1);
            settings.image.layers = {"albedo"};
            settings.surface.mode = mode;
            const Image image = render(std::move(scene), settings).image;
            const size_t albedo = image.find_channel("albedo.G").value();
            EXPECT_FLOAT_EQ(image.at(6, 8, albedo), 0.25f);
            EXPECT_FLOAT_EQ(image.at(10, 8, albedo), 0.75f);
        }
}

TEST(UvSets, may_differ_between_the_objects_of_one_mesh) {
    const Material material = make_set_materials()[0];
    const Mesh mesh = make_two_set_sphere();
    const auto place = [&](const Material& left, const Material& right) {
        Scene scene = make_set_scene(mesh, left);
        scene.materials.push_back(right);
        scene.objects.push_back(scene.objects[0]);
        scene.objects.back().material = 2;
        scene.objects[0].world_from_object.translation = {-1, 0, 0};
        scene.objects.back().world_from_object.translation = {1, 0, 0};
        return scene;
    };
    const Material further = put_on_set(material, kFurtherSet);
    const auto both = render_set_pixels(place(material, further));
    EXPECT_NE(both, render_set_pixels(place(material, material)));
    EXPECT_NE(both, render_set_pixels(place(further, further)));
    EXPECT_NE(both, render_set_pixels(place(further, material)));
}

TEST(UvSets, are_there_when_a_session_goes_on_to_a_material_that_names_one) {
    const Material material = make_set_materials()[0];
    const Mesh mesh = make_two_set_sphere();
    const RenderSettings settings = make_small_settings(16, 2, 2);
    Session session(make_set_scene(mesh, material), settings, SessionUse::scenes);
    for (const Material& next : {put_on_set(material, kFurtherSet), material}) {
        Scene scene = make_set_scene(mesh, next);
        const auto expected = render(scene, settings).image.pixels;
        for (Mesh& left_out : scene.meshes) {
            Mesh empty;
            empty.name = left_out.name;
            left_out = empty;
        }
        session.change_scene({scene, scene.camera, 1}, settings.image);
        EXPECT_EQ(session.render().image.pixels, expected);
    }
}

} // namespace
} // namespace relief
