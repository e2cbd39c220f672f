// What a scene is warned of when it is prepared.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "prepare/prepared_scene.h"
#include "relief/error.h"
#include "relief/render.h"
#include "support/bodies.h"

namespace relief {
namespace {

std::vector<std::string> prepare_with_crease(float sharpness, int level, CreaseRule rule) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(8, 8, 0.1f, 1), DisplacementSpace::object));
    scene.environment.emplace();
    scene.meshes[0].creases = {{0, 1, sharpness}, {1, 2, kInfiniteSharpness}};
    scene.meshes[0].subdivision.scheme = SubdivisionScheme::catmark;
    scene.meshes[0].subdivision.level = level;
    scene.meshes[0].subdivision.creases = rule;
    return prepare_scene(std::move(scene), {})->warnings;
}

TEST(Warnings, name_the_level_that_shows_a_semi_sharp_crease_as_it_is) {
    const std::vector<std::string> warnings = prepare_with_crease(2.5f, 1, CreaseRule::obey);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("sharpness 2.5"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("level 2 shows"), std::string::npos) << warnings[0];
    EXPECT_TRUE(prepare_with_crease(2.5f, 2, CreaseRule::obey).empty());
    EXPECT_TRUE(prepare_with_crease(0.5f, 1, CreaseRule::obey).empty());
    EXPECT_TRUE(prepare_with_crease(2.5f, 1, CreaseRule::ignore).empty());
    EXPECT_TRUE(prepare_with_crease(0, 0, CreaseRule::obey).empty());
    Scene plain = test::make_body_scene(test::make_torus(4, 6), {});
    plain.environment.emplace();
    plain.objects[0].displacement = kNoIndex, plain.displacements.clear();
    plain.meshes[0].creases = {{0, 1, 2.5f}};
    plain.meshes[0].subdivision.scheme = SubdivisionScheme::catmark;
    plain.meshes[0].subdivision.level = 1;
    EXPECT_TRUE(prepare_scene(std::move(plain), {})->warnings.empty()) << "no patch is fitted";
    EXPECT_NE(prepare_with_crease(0.5f, 0, CreaseRule::obey)[0].find("level 1 shows"), std::string::npos);
}

TEST(Warnings, tell_of_noise_that_is_never_judged) {
    const auto prepare = [](float noise, int spp) {
        RenderSettings settings;
        settings.image.noise = noise, settings.image.spp = spp;
        Scene scene = test::make_body_scene(test::make_torus(4, 6), {});
        scene.environment.emplace();
        scene.objects[0].displacement = kNoIndex, scene.displacements.clear();
        return prepare_scene(std::move(scene), settings)->warnings;
    };
    ASSERT_EQ(prepare(0.1f, 16).size(), 1u);
    EXPECT_NE(prepare(0.1f, 12)[0].find("pixels get 12 at most"), std::string::npos);
    EXPECT_TRUE(prepare(0.1f, 17).empty());
    EXPECT_TRUE(prepare(0, 12).empty());
}

TEST(Warnings, count_the_faces_without_area_and_name_the_first) {
    Scene scene = test::make_body_scene(test::make_torus(4, 6), {});
    scene.objects[0].displacement = kNoIndex, scene.displacements.clear();
    scene.environment.emplace();
    Mesh& mesh = scene.meshes[0];
    const size_t faces = mesh.face_sizes.size();
    for (int copy = 0; copy < 2; ++copy) { // an edge twice
        mesh.face_sizes.push_back(3);
        for (const uint32_t index : {0u, 1u, 1u}) {
            mesh.position_indices.push_back(index);
            if (!mesh.uv_indices.empty()) mesh.uv_indices.push_back(0);
        }
    }
    const std::vector<std::string> warnings = prepare_scene(std::move(scene), {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 of " + std::to_string(faces + 2) + " faces have no area"),
              std::string::npos)
        << warnings[0];
    EXPECT_NE(warnings[0].find("the first is face " + std::to_string(faces)), std::string::npos)
        << warnings[0];
}

TEST(Warnings, count_the_faces_without_uvs_and_name_the_first) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(8, 8, 0.1f, 1), DisplacementSpace::object));
    scene.environment.emplace();
    test::remove_uvs(scene.meshes[0], 5);
    Scene plain = scene;
    const std::vector<std::string> warnings = prepare_scene(std::move(scene), {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("4 of 24 faces have no uvs"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("the first is face 4"), std::string::npos) << warnings[0];
    plain.objects[0].displacement = kNoIndex;
    EXPECT_TRUE(prepare_scene(std::move(plain), {})->warnings.empty()) << "nothing reads uvs";
}

TEST(Warnings, count_the_faces_without_uvs_in_a_set_that_a_texture_names) {
    Scene scene = test::make_body_scene(test::make_torus(4, 6), {});
    scene.displacements.clear(), scene.objects[0].displacement = kNoIndex;
    scene.environment.emplace();
    Mesh& mesh = scene.meshes[0];
    mesh.further_uvs = {{3, mesh.uvs, mesh.uv_indices}};
    for (size_t corner = 8; corner < 16; ++corner) mesh.further_uvs[0].indices[corner] = kNoIndex;
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty()) << "nothing reads it";
    scene.materials.emplace_back();
    scene.objects[0].material = 0;
    const auto texture = test::make_random_map(8, 8, 0.1f, 1);
    scene.materials[0].textures = {
        {.input = MaterialInput::roughness, .tiles = {{1001, texture}}, .uv_set = 3}};
    const std::vector<std::string> warnings = prepare_scene(std::move(scene), {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(
        warnings[0].find("2 of 24 faces have no uvs in set 3: textures on it are read at (0, 0) there; the "
                         "first is face 2"),
        std::string::npos)
        << warnings[0];
}

/// A torus with one face in tile 1002, one outside of all tiles, and the rest in tile 1001.
Scene make_scene_with_texture_tiles() {
    Scene scene = test::make_body_scene(test::make_torus(4, 6), {});
    scene.displacements.clear(), scene.objects[0].displacement = kNoIndex;
    scene.environment.emplace();
    Mesh& mesh = scene.meshes[0];
    mesh.name = "body", mesh.uvs.clear(), mesh.uv_indices.clear();
    for (size_t face = 0; face < mesh.face_sizes.size(); ++face) {
        const float left = face == 5 ? 1.25f : face == 7 ? 12.25f : 0.25f;
        for (const Vec2f& uv :
             {Vec2f{left, 0.25f}, {left + 0.5f, 0.25f}, {left + 0.5f, 0.75f}, {left, 0.75f}})
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size())), mesh.uvs.push_back(uv);
    }
    scene.materials.emplace_back().name = "paint";
    scene.objects[0].material = 0;
    scene.materials[0].textures = {{.input = MaterialInput::base_color,
                                    .tiles = {{1001, test::make_random_map(8, 8, 0.1f, 1)}},
                                    .is_udim = true}};
    return scene;
}

TEST(Warnings, name_tiles_that_a_texture_lacks_and_faces_outside_of_all) {
    Scene scene = make_scene_with_texture_tiles();
    scene.objects.push_back(scene.objects[0]); // the same again is no other warning
    const std::vector<std::string> warnings = prepare_scene(scene, {})->warnings;
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(
        warnings[0].find("the texture of base_color of material 'paint' has no file for tile(s) 1002 of "
                         "mesh 'body'"),
        std::string::npos)
        << warnings[0];
    EXPECT_NE(warnings[1].find("the texture of base_color of material 'paint' on mesh 'body': 1 face lies "
                               "outside of all tiles (u from 0 to 10, v from 0), the first is face 7"),
              std::string::npos)
        << warnings[1];
    scene.materials[0].textures[0].is_udim = false;
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty()) << "it repeats";
}

TEST(Warnings, of_tiles_of_textures_go_by_the_uvs_that_are_read) {
    Scene scene = make_scene_with_texture_tiles();
    InputTexture& texture = scene.materials[0].textures[0];
    texture.uv_scale = {0.05f, 1}; // all into the first tile
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty());
    for (const auto& [offset, text] : {std::pair(Vec2f{0, -3}, "24 faces lie outside of all tiles"),
                                       {Vec2f{2, 1}, "tile(s) 1013 of mesh"}}) {
        texture.uv_offset = offset;
        const std::vector<std::string> warnings = prepare_scene(scene, {})->warnings;
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find(text), std::string::npos) << warnings[0];
    }
}

TEST(Warnings, of_tiles_of_textures_go_by_the_uv_set_that_a_texture_names) {
    Scene scene = make_scene_with_texture_tiles();
    Mesh& mesh = scene.meshes[0];
    mesh.further_uvs = {{3, mesh.uvs, mesh.uv_indices}};
    for (Vec2f& uv : mesh.further_uvs[0].uvs) uv = {uv.x - std::floor(uv.x), uv.y + 2};
    InputTexture& texture = scene.materials[0].textures[0];
    texture.uv_set = 3;
    const std::vector<std::string> warnings = prepare_scene(scene, {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("tile(s) 1021 of mesh"), std::string::npos) << warnings[0];
    texture.tiles[0].udim = 1021;
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty());
}

TEST(Warnings, say_when_nothing_gives_light_or_is_there) {
    const auto prepare = [](const std::function<void(Scene&)>& change) {
        Scene scene = test::make_body_scene(test::make_torus(4, 6), {});
        scene.objects[0].displacement = kNoIndex, scene.displacements.clear();
        scene.lights.clear(), scene.environment.reset();
        scene.materials.assign(1, Material{}), scene.objects[0].material = 0;
        change(scene);
        return prepare_scene(std::move(scene), {})->warnings;
    };
    const auto expect_dark = [&](const std::function<void(Scene&)>& change, size_t count) {
        const std::vector<std::string> warnings = prepare(change);
        ASSERT_EQ(warnings.size(), count);
        if (count > 0) EXPECT_NE(warnings[0].find("nothing in the scene gives light"), std::string::npos);
    };
    expect_dark([](Scene&) {}, 1);
    expect_dark([](Scene& scene) { scene.objects[0].material = kNoIndex; }, 1);
    expect_dark([](Scene& scene) { scene.materials[0].emission = {0, 0.1f, 0}; }, 0);
    expect_dark([](Scene& scene) { scene.lights.emplace_back(); }, 0);
    expect_dark([](Scene& scene) { scene.lights.emplace_back().strength = 0; }, 1);
    expect_dark([](Scene& scene) { scene.environment.emplace(); }, 0);
    expect_dark([](Scene& scene) { scene.environment.emplace().color = {0, 0, 0}; }, 1);
    const std::vector<std::string> empty = prepare([](Scene& scene) { scene.objects.clear(); });
    ASSERT_EQ(empty.size(), 1u);
    EXPECT_NE(empty[0].find("no objects; only its environment"), std::string::npos);
}

TEST(Prepare, tells_the_pixel_of_a_nan_whatever_the_filter) {
    for (const MapFilter filter : {MapFilter::none, MapFilter::mip}) {
        auto map = test::make_random_map(64, 64, 0.1f, 1);
        map->floats[4 * (50 * 64 + 40)] = NAN;
        Scene scene = test::make_body_scene(test::make_torus(4, 6),
                                            test::make_displacement(map, DisplacementSpace::object));
        scene.displacements[0].filter = filter;
        try {
            prepare_scene(std::move(scene), {});
            FAIL();
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("(40, 50)"), std::string::npos) << error.what();
        }
    }
}

TEST(Prepare, leaves_detail_out_of_tessellated_surfaces) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(64, 64, 0.01f, 1), DisplacementSpace::object));
    scene.environment = Environment{};
    RenderSettings settings;
    settings.image.width = settings.image.height = 24, settings.image.spp = 1, settings.surface.level = 3,
    settings.image.layers = {"N"};
    settings.surface.mode = SurfaceMode::tessellated;
    const Image plain = render(scene, settings).image;
    scene.displacements[0].autobump = true;
    EXPECT_EQ(render(scene, settings).image.pixels, plain.pixels);
    settings.surface.mode = SurfaceMode::direct;
    EXPECT_NE(render(scene, settings).image.pixels, plain.pixels);
}

TEST(Warnings, name_the_tiles_that_have_no_file) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(8, 8, 0.1f, 1), DisplacementSpace::object));
    scene.environment.emplace();
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty());
    scene.displacements[0].is_udim = true;
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty());
    for (Vec2f& uv : scene.meshes[0].uvs) uv.x *= 2;
    const std::vector<std::string> warnings = prepare_scene(scene, {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("tile(s) 1002 of mesh 'torus'"), std::string::npos) << warnings[0];
}

TEST(Warnings, name_faces_across_tiles_and_outside_of_all_tiles) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(8, 8, 0.1f, 1), DisplacementSpace::object));
    scene.environment.emplace();
    scene.displacements[0].is_udim = true;
    scene.displacements[0].tiles.push_back({1002, scene.displacements[0].tiles[0].texture});
    Mesh& mesh = scene.meshes[0];
    for (Vec2f& uv : mesh.uvs) uv.x += 0.9f;
    std::vector<std::string> warnings = prepare_scene(scene, {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("faces lie across two tiles or more"), std::string::npos) << warnings[0];
    for (Vec2f& uv : mesh.uvs) uv.x += 9.1f;
    warnings = prepare_scene(scene, {})->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("24 faces lie outside of all tiles"), std::string::npos) << warnings[0];
    for (Vec2f& uv : mesh.uvs) uv.x += 1e-6f - 10; // the rounding of a file
    EXPECT_TRUE(prepare_scene(scene, {})->warnings.empty());
}

} // namespace
} // namespace relief
