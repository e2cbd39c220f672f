#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/suggest.h"
#include "io/scene/displacement_reader.h"
#include "io/scene/scene_reader.h"
#include "io/scene_files.h"
#include "math/vec.h"
#include "relief/io.h"
#include "scene/displacement_conventions.h"
#include "support/input_textures.h"

namespace relief {

/// Largest distance of the points from the middle of a square picture, 1 at its border.
float measure_fill(const Camera& camera, const std::vector<Vec3f>& points) {
    const Vec3f forward = normalize(camera.to - camera.from), right = normalize(cross(forward, camera.up));
    const Vec3f up = cross(right, forward);
    const float tangent = std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    float result = 0;
    for (const Vec3f& p : points) {
        const Vec3f d = p - camera.from;
        const float side = std::max(std::fabs(dot(d, right)), std::fabs(dot(d, up)));
        result = std::max(result, side / (dot(d, forward) * tangent));
    }
    return result;
}

TEST_F(SceneFiles, broken_json_says_what_may_be_wrong) {
    EXPECT_HAS(error_of(R"({"version": 1 "render": {}})"), "line 1, column 22");
    EXPECT_HAS(error_of(R"({"version": 1 "render": {}})"), "a comma may be missing before it");
    EXPECT_HAS(error_of(R"({"materials": {"a": {"base_color": [1 2 3]}}})"), "a comma may be missing");
    EXPECT_HAS(error_of(R"({"version": 1, })"), "a comma too many before it");
    EXPECT_HAS(error_of(R"({version: 1})"), "a key without quotes");
    for (const char* cut : {R"({"version": 1)", R"({"version": 1,)", "{", ""})
        EXPECT_HAS(error_of(cut), "is a bracket not closed?") << cut;
    EXPECT_HAS(error_of(R"({"version" 1})"), "a colon is missing before it");
    EXPECT_HAS(error_of(R"({"camera": {"from": [1, 2, ]}})"), "a comma too many before it");
    EXPECT_HAS(error_of(R"({"camera": [[1] [2]]})"), "a comma may be missing before it");
}

TEST_F(SceneFiles, every_field_is_read) {
    write_pixels<float>("env.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3, 4, 5, 6});
    write_pixels<uint8_t>("color.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0});
    const Scene scene = parse(R"({ "version": 1, // comment
      "render": {"width": 64, "height": 32, "spp": 4, "bounces": 2, "seed": 4294967295},
      "camera": {"from": [0, 0, 4], "to": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 50, "aperture_radius": 0.5,
        "shift": [0.25, -1]},
      "environment": {"file": "env.exr", "color": [1, 1, 0.5], "strength": 2, "rotate_degrees": 40}, /* more */
      "materials": {"clay": {"base_color": [0.1, 0.2, 0.3], "roughness": 0.4, "metallic": 1, "ior": 1.3,
        "emission": [1, 2, 3], "base_color_texture": "color.png",
        "roughness_texture": {"file": "color.png", "filter": "cubic"},
        "metallic_texture": {"file": "color.png", "channel": "g"}}},
      "displacements": {"ear": {"type": "vector", "file": "map.exr", "preset": "mudbox", "midlevel": 0.25,
        "scale": [1, 2, 3], "flip_v": true, "wrap": "mirror", "dilate": false, "filter": "mip",
        "autobump": true, "frame": "dpdu", "lengths": "relative"}},
      "meshes": {"plane": {"file": "plane.obj"}},
      "objects": [{"name": "o", "mesh": "plane", "displacement": "ear", "material": "clay",
        "transform": {"translate": [1, 2, 3], "rotate_degrees": [0, 90, 0], "scale": 2}}],
      "lights": [{"type": "sun", "direction": [0, -2, 0], "angle_degrees": 2, "strength": 3},
                 {"type": "point", "position": [1, 1, 1], "radius": 0.5, "color": [1, 0, 0]}] })");
    EXPECT_EQ(scene.picture.seed, 4294967295u);
    EXPECT_EQ(scene.picture.width, 64);
    EXPECT_EQ(scene.camera.focus_distance, 4);
    EXPECT_EQ(scene.camera.shift, (Vec2f{0.25f, -1}));
    EXPECT_EQ(scene.environment->texture->floats.at(3), 4);
    EXPECT_EQ(scene.materials.at(0).ior, 1.3f);
    EXPECT_NEAR(test::get_texture(scene.materials[0], MaterialInput::base_color)->floats.at(1), 0.2158605f,
                1e-6f);
    EXPECT_EQ(test::get_texture(scene.materials[0], MaterialInput::roughness)->floats.at(0), 1);
    EXPECT_EQ(test::get_texture(scene.materials[0], MaterialInput::metallic)->floats.at(0), 128 / 255.f);
    EXPECT_EQ(test::get_filter(scene.materials[0], MaterialInput::base_color), MapFilter::none);
    EXPECT_EQ(test::get_filter(scene.materials[0], MaterialInput::roughness), MapFilter::cubic);
    const Displacement& map = scene.displacements.at(0);
    EXPECT_EQ(map.axes.axis, (std::array<uint8_t, 3>{0, 2, 1}));
    EXPECT_EQ(map.midlevel, (Vec3f{.25f, .25f, .25f}));
    EXPECT_EQ(map.scale, (Vec3f{1, 2, 3}));
    EXPECT_TRUE(map.flip_v);
    EXPECT_FALSE(map.dilate);
    EXPECT_EQ(map.filter, MapFilter::mip);
    EXPECT_TRUE(map.autobump);
    EXPECT_EQ(map.frame, FrameKind::dpdu);
    EXPECT_EQ(map.lengths, FrameLengths::relative);
    EXPECT_EQ(map.wrap, WrapMode::mirror);
    EXPECT_EQ(scene.objects.at(0).world_from_object.translation, (Vec3f{1, 2, 3}));
    EXPECT_EQ(scene.objects[0].world_from_object.rows[0], (Vec3f{0, 0, 2}));
    EXPECT_EQ(scene.lights.at(1).radius, 0.5f);
    EXPECT_NE(scene.hash, 0u);
}

TEST_F(SceneFiles, smooth_filters_are_read_and_refused_where_they_make_no_sense) {
    write_pixels<uint8_t>("steps.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0});
    const auto read = [&](const std::string& text) { return parse(with_map(text)).displacements.at(0); };
    const Displacement map =
        read(R"("file": "steps.png", "midlevel": 0.5, "filter": "bspline", "dequantize": true)");
    EXPECT_EQ(map.filter, MapFilter::bspline);
    EXPECT_TRUE(map.dequantize);
    EXPECT_FALSE(read(R"("file": "map.exr", "filter": "cubic")").dequantize);
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "filter": "cubi")")), "did you mean 'cubic'?");
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "filter": "cubic", "dequantize": true)")),
               "maps of 8 or 16-bit integers, which");
    EXPECT_HAS(error_of(with_map(R"("file": "steps.png", "midlevel": 0.5, "dequantize": true)")),
               "dequantize needs a smooth filter");
    EXPECT_HAS(
        error_of(R"({"materials": {"a": {"base_color_texture": {"file": "steps.png", "filter": "mip"}}}})"),
        "filter mip is for displacement maps");
    EXPECT_HAS(error_of(R"({"materials": {"a": {"base_color_texture": {"filter": "cubic"}}}})"), "'file'");
    EXPECT_HAS(
        error_of(R"({"materials": {"a": {"base_color_texture": {"file": "steps.png", "fliter": "cubic"}}}})"),
        "did you mean 'filter'?");
    EXPECT_HAS(
        error_of(R"({"materials": {"a": {"metallic_texture": {"file": "steps.png", "channel": "a"}}}})"),
        "no channel a: there are 3");
    EXPECT_HAS(
        error_of(R"({"materials": {"a": {"metallic_texture": {"file": "steps.png", "channel": "z"}}}})"),
        "unknown channel 'z'");
    EXPECT_HAS(
        error_of(R"({"materials": {"a": {"base_color_texture": {"file": "steps.png", "channel": "g"}}}})"),
        "channel");
    Scene scene =
        parse(with_map(R"("file": "steps.png", "midlevel": 0.5, "filter": "cubic", "dequantize": true)"));
    EXPECT_HAS(message_of([&] { save_scene(scene, folder_ / "out"); }), "maps are written as floats");
}

TEST_F(SceneFiles, broken_text_is_located) {
    EXPECT_HAS(error_of("{\n  \"camera\": {\n    \"from\" [1]\n"), "s.json, line 3, column 12");
    EXPECT_HAS(error_of(R"({"materials": {"a": {}, "a": {}}})"), "'a' stands twice");
    EXPECT_HAS(message_of([&] { load_scene(folder_ / "none.json"); }), "file not found");
}

TEST_F(SceneFiles, unknown_keys_get_a_suggestion) {
    EXPECT_EQ(error_of(R"({"materials": {"clay": {"rougness": 1}}})"),
              "s.json: unknown key 'rougness' in materials.clay (did you mean 'roughness'?)");
    EXPECT_HAS(error_of(R"({"matrials": {}})"), "did you mean 'materials'?");
    EXPECT_HAS(error_of(R"({"camera": {"fov": 40}})"), "did you mean 'fov_degrees'?");
    const std::vector<std::string_view> ears = {"ear_of_the_left_side", "ear_of_the_right_side",
                                                "--of_the_nose"};
    EXPECT_EQ(suggest_word("ear_of_the_r", ears), "did you mean 'ear_of_the_right_side'?");
    for (const char* unclear : {"ear", "ea", "--o"}) EXPECT_HAS(suggest_word(unclear, ears), "known: ");
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "preset": "mudbx")")), "did you mean 'mudbox'?");
    EXPECT_HAS(error_of(R"({"objects": [{"mesh": "plane"}]})"), "objects[0].mesh: there is no mesh 'plane'");
}

TEST_F(SceneFiles, mistakes_of_independent_parts_are_told_together) {
    const auto find = [&](const std::string& text) -> std::vector<Error::Parts> {
        try {
            parse(text);
        } catch (const Error& error) {
            std::vector<Error::Parts> all = {{error.message(), error.where(), error.hint()}};
            all.insert(all.end(), error.further().begin(), error.further().end());
            return all;
        }
        return {};
    };
    const std::vector<Error::Parts> all = find(R"({"displacements": [], "materials":
        {"a": {"rougness": 1}, "b": {"roughness": 2}}, "meshes": {"gone": {"file": "gone.obj"}},
        "objects": [{"mesh": "gone"}, {"mesh": "there", "material": "a"}], "lights": {}})");
    ASSERT_EQ(all.size(), 6u) << "and none of the object whose mesh cannot be read";
    EXPECT_HAS(all[0].message, "rougness");
    EXPECT_HAS(all[1].where, "materials.b.roughness");
    EXPECT_HAS(all[2].where, "displacements");
    EXPECT_HAS(all[3].message, "file not found");
    EXPECT_HAS(all[4].message, "there is no mesh 'there'");
    EXPECT_HAS(all[5].where, "lights");
    EXPECT_EQ(find(R"({"render": {"spp": 0}, "camera": {"fov_degrees": 200},
        "meshes": {"gone": {"file": "gone.obj"}}})")
                  .size(),
              2u)
        << "before files are read";
    std::string many = R"({"objects": [)";
    for (int k = 0; k < 1000; ++k) many += R"({"mash": "a"},)";
    EXPECT_EQ(find(many + R"({"mesh": "a"}]})").size(), 10u) << "the rest is not read";
}

TEST_F(SceneFiles, wrong_values_are_named_with_their_path) {
    EXPECT_HAS(error_of(with_object(R"(, "transform": {"scale": "big"})")), "objects[0].transform.scale");
    EXPECT_HAS(error_of(with_object(R"(, "transform": {"scale": [1, 0, 1]})")), "singular");
    EXPECT_HAS(error_of(with_object(R"(, "transform": {"matrix": [1, 2]})")), "16 numbers");
    EXPECT_HAS(error_of(with_object(R"(, "shadow_catcher": "yes")")), "objects[0].shadow_catcher");
    EXPECT_HAS(error_of(R"({"camera": {"fov_degrees": 200}})"), "camera.fov_degrees: must be in");
    EXPECT_HAS(error_of(R"({"camera": {"shift": [0, 101]}})"), "camera.shift[1]: must be in");
    EXPECT_HAS(error_of(R"({"camera": {"shift": [0]}})"), "camera.shift: must be 2 numbers, not 1");
    EXPECT_HAS(error_of(R"({"render": {"width": 0}})"), "render.width");
    EXPECT_HAS(error_of(R"({"render": {"spp": -4}})"), "render.spp");
    EXPECT_HAS(error_of(R"({"materials": {"m": {"base_color": [1, 2, 0]}}})"), "materials.m.base_color[1]");
    EXPECT_HAS(error_of("[]"), "must be an object");
}

TEST_F(SceneFiles, axes_are_signed_permutations_of_one_set_of_letters) {
    const AxisText axes = parse_axes("x, -z ,y");
    EXPECT_EQ(axes.axes.axis, (std::array<uint8_t, 3>{0, 2, 1}));
    EXPECT_EQ(axes.axes.sign, (std::array<int8_t, 3>{1, -1, 1}));
    EXPECT_FALSE(axes.is_tangent);
    for (const char* text : {"", "t,b", "t,t,n", "t,b,z", "t,b,n,n", "tbn", "t,b,--n"})
        EXPECT_THROW(parse_axes(text), Error) << text;
    EXPECT_EQ(format_axes(parse_axes("t,-n,b").axes, DisplacementSpace::tangent), "t,-n,b");
    EXPECT_EQ(parse(with_map(R"("file": "map.exr", "axes": "x,-z,y")")).displacements[0].space,
              DisplacementSpace::object);
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "axes": "t,b,n", "space": "object")")), "do not fit");
}

TEST_F(SceneFiles, integer_maps_are_centred_with_a_warning) {
    write_pixels<uint8_t>("m.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {128, 128, 255});
    const Scene scene = parse(with_map(R"("file": "m.png", "preset": "genvdm")"));
    EXPECT_EQ(scene.displacements[0].midlevel, (Vec3f{.5f, .5f, .5f}));
    ASSERT_EQ(scene.warnings.size(), 2u);
    EXPECT_HAS(scene.warnings[0], "8-bit map");
    EXPECT_HAS(scene.warnings[1], "0.5 is assumed");
    EXPECT_EQ(parse(with_map(R"("file": "m.png", "midlevel": 0)")).displacements[0].midlevel, (Vec3f{}));
    write_pixels<float>("h.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {1});
    EXPECT_EQ(parse(with_map(R"("file": "h.exr")")).displacements[0].type, DisplacementType::height);
}

TEST_F(SceneFiles, bad_texels_are_named_with_pixel_and_tile) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write_pixels<float>("n.exr", 2, 2, 3, OIIO::TypeDesc::FLOAT, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, nan, 0});
    write_pixels<uint16_t>("u.1012.exr", 2, 1, 3, OIIO::TypeDesc::HALF, {0, 0, 0, 0, 0, 0x7c00});
    const std::string message = error_of(with_map(R"("file": "n.exr")"));
    EXPECT_HAS(message, "displacements.ear");
    EXPECT_HAS(message, "n.exr, pixel (1, 1): NaN in channel G");
    EXPECT_HAS(error_of(with_map(R"("file": "u.<UDIM>.exr")")),
               "pixel (1, 0), tile 1012: infinity in channel B");
    EXPECT_HAS(error_of(R"({"environment": {"file": "n.exr"}})"), "pixel (1, 1)");
    write_pixels<float>("y.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {nan});
    EXPECT_HAS(error_of(with_map(R"("file": "y.exr")")), "y.exr, pixel (0, 0): NaN (repair");
}

TEST_F(SceneFiles, missing_uvs_and_singular_objects_are_refused) {
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const std::string message = error_of(R"({"meshes": {"bare": {"file": "bare.obj"}},
        "displacements": {"ear": {"file": "map.exr"}}, "objects": [{"name": "o", "mesh": "bare", "displacement": "ear"}]})");
    EXPECT_HAS(message, "object 'o': mesh 'bare' has no uvs");
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    EXPECT_HAS(message_of([&] { load_mesh_scene(folder_ / "bare.obj", options); }), "has no uvs");
}

TEST_F(SceneFiles, udim_tiles_are_found_and_files_are_shared) {
    for (const char* name : {"t.1011.exr", "t.1001.exr", "t.x001.exr"})
        write_pixels<float>(name, 1, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3});
    const Scene scene = parse(R"({"displacements": {"a": {"file": "t.<UDIM>.exr"}, "b": {"file": "map.exr"},
                                  "c": {"file": "./map.exr"}}})");
    const Displacement& map = scene.displacements.at(0);
    ASSERT_EQ(map.tiles.size(), 2u);
    EXPECT_EQ(map.tiles[0].udim, 1001);
    EXPECT_EQ(map.tiles[1].udim, 1011);
    EXPECT_EQ(scene.displacements[1].tiles[0].texture, scene.displacements[2].tiles[0].texture);
    EXPECT_HAS(error_of(with_map(R"("file": "none.<UDIM>.exr")")), "no tile file found");
}

TEST_F(SceneFiles, the_hash_follows_the_content_and_not_the_picture_size) {
    const std::string object = with_object("");
    const auto with_render = [&](const char* render) {
        return R"({"render": )" + std::string(render) + "," + object.substr(1);
    };
    const uint64_t hash = parse(with_render(R"({"width": 10})")).hash;
    EXPECT_EQ(hash, parse(with_render(R"({"width": 20, "spp": 3})")).hash);
    EXPECT_NE(hash, parse(with_object(R"(, "transform": {"scale": 2})")).hash);
    std::string text = kQuadObj;
    write("plane.obj", text.replace(2, 2, "-2"));
    EXPECT_NE(hash, parse(with_render(R"({"width": 10})")).hash);
}

TEST_F(SceneFiles, the_hash_follows_the_shape_of_maps_and_the_numbers_of_tiles) {
    const std::vector<float> texels(12, 0.5f);
    const auto hash_map = [&](int width, int height) {
        write_pixels<float>("shape.exr", width, height, 3, OIIO::TypeDesc::FLOAT, texels);
        return parse(with_map(R"("file": "shape.exr")")).hash;
    };
    EXPECT_NE(hash_map(4, 1), hash_map(1, 4));
    const auto hash_tile = [&](const std::string& number) {
        const std::string name = "tile." + number + ".exr";
        write_pixels<float>(name, 2, 2, 3, OIIO::TypeDesc::FLOAT, texels);
        const uint64_t hash = parse(with_map(R"("file": "tile.<UDIM>.exr")")).hash;
        std::filesystem::remove(folder_ / name);
        return hash;
    };
    EXPECT_NE(hash_tile("1001"), hash_tile("1002"));
    EXPECT_EQ(hash_tile("1001"), hash_tile("1001"));
}

TEST_F(SceneFiles, a_saved_scene_loads_as_the_same_scene) {
    write_pixels<float>("env.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3, 4, 5, 6});
    for (const char* name : {"h.1001.exr", "h.1002.exr"})
        write_pixels<uint16_t>(name, 1, 1, 3, OIIO::TypeDesc::HALF, {0x3c01, 1, 0x8000});
    Scene scene = parse(R"({"render": {"seed": 3}, "environment": {"file": "env.exr", "strength": 0.1},
        "camera": {"from": [0.1, 0.2, 0.3]}, "materials": {"m n": {"roughness": 0.3,
            "base_color_texture": {"file": "env.exr", "filter": "bspline"}, "opacity": 0.1,
            "metallic_texture": {"file": "env.exr", "channel": "g"},
            "opacity_texture": {"file": "env.exr", "channel": "b", "filter": "cubic"},
            "geometry_normal": {"file": "map.exr", "scale": 0.25, "flip_y": true}}, "plain": {"normal_texture": "map.exr"}},
        "displacements": {"z": {"file": "h.<UDIM>.exr", "axes": "t,-n,b", "midlevel": 0.1, "frame": "file",
                                "filter": "mip", "autobump": true, "dilate": false},
                          "a": {"file": "map.exr", "axes": "x,-z,y", "scale": 0.7, "wrap": "black", "frame": "dpdu",
                                "lengths": "relative", "filter": "cubic"}},
        "meshes": {"p/q": {"file": "plane.obj"}}, "lights": [{"type": "point", "strength": 0.3}],
        "objects": [{"mesh": "p/q", "displacement": "a", "material": "m n",
                     "transform": {"rotate_degrees": [10, 20, 30], "scale": 0.3}}, {"mesh": "p/q", "displacement": "z", "shadow_catcher": true}]})");
    scene.meshes[0].positions[0] = {0.1f, 1e-20f, 12345.678f};
    save_scene(scene, folder_ / "out");
    const Scene read = load_scene(folder_ / "out" / "scene.json");
    EXPECT_EQ(read.meshes.at(0).positions, scene.meshes[0].positions);
    EXPECT_EQ(read.meshes[0].uvs, scene.meshes[0].uvs);
    EXPECT_EQ(read.meshes[0].uv_indices, scene.meshes[0].uv_indices);
    EXPECT_EQ(read.meshes[0].name, "p/q");
    ASSERT_EQ(read.displacements.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        const Displacement &a = read.displacements[i], &b = scene.displacements[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.axes, b.axes);
        EXPECT_EQ(a.space, b.space);
        EXPECT_EQ(a.wrap, b.wrap);
        EXPECT_EQ(a.frame, b.frame);
        EXPECT_EQ(a.lengths, b.lengths);
        EXPECT_EQ(a.filter, b.filter);
        EXPECT_EQ(a.autobump, b.autobump);
        EXPECT_EQ(a.dilate, b.dilate);
        EXPECT_EQ(a.midlevel, b.midlevel);
        EXPECT_EQ(a.scale, b.scale);
        ASSERT_EQ(a.tiles.size(), b.tiles.size());
        for (size_t t = 0; t < a.tiles.size(); ++t) {
            EXPECT_EQ(a.tiles[t].udim, b.tiles[t].udim);
            EXPECT_EQ(a.tiles[t].texture->floats, b.tiles[t].texture->floats);
            EXPECT_EQ(a.tiles[t].texture->halves, b.tiles[t].texture->halves);
        }
    }
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.objects.at(i).world_from_object, scene.objects[i].world_from_object);
        EXPECT_EQ(read.objects[i].material, scene.objects[i].material);
        EXPECT_EQ(read.objects[i].is_shadow_catcher, i == 1);
    }
    const Material &material = read.materials.at(0), &given = scene.materials[0];
    EXPECT_EQ(test::get_filter(material, MaterialInput::base_color), MapFilter::bspline);
    EXPECT_EQ(material.opacity, 0.1f);
    EXPECT_EQ(test::get_texture(material, MaterialInput::metallic)->floats,
              test::get_texture(given, MaterialInput::metallic)->floats);
    EXPECT_EQ(test::get_texture(material, MaterialInput::metallic)->floats.at(0), 2);
    EXPECT_EQ(test::get_texture(material, MaterialInput::opacity)->floats,
              test::get_texture(given, MaterialInput::opacity)->floats);
    EXPECT_EQ(test::get_filter(material, MaterialInput::opacity), MapFilter::cubic);
    EXPECT_EQ(test::get_texture(material, MaterialInput::normal)->floats,
              test::get_texture(given, MaterialInput::normal)->floats);
    EXPECT_EQ(material.normal_scale, 0.25f);
    EXPECT_TRUE(material.normal_flip_y);
    EXPECT_EQ(test::get_texture(read.materials.at(1), MaterialInput::normal)->floats,
              test::get_texture(given, MaterialInput::normal)->floats);
    EXPECT_EQ(read.materials[1].normal_scale, 1);
    EXPECT_FALSE(read.materials[1].normal_flip_y);
    EXPECT_EQ(read.camera.from, scene.camera.from);
    EXPECT_EQ(read.environment->strength, 0.1f);
    EXPECT_EQ(read.environment->texture->floats, scene.environment->texture->floats);
    EXPECT_EQ(read.lights.at(0).strength, 0.3f);
    EXPECT_EQ(read.picture.seed, 3u);
    EXPECT_TRUE(read.warnings.empty());
    scene.meshes[0].tangents.assign(scene.meshes[0].position_indices.size(), {1, 0, 0, 1});
    EXPECT_HAS(message_of([&] { save_scene(scene, folder_ / "lost"); }), "tangents");
}

TEST_F(SceneFiles, frames_have_names_and_count_in_the_hash) {
    const Displacement plain = parse(with_map(R"("file": "map.exr")")).displacements[0];
    EXPECT_EQ(plain.frame, FrameKind::mikk);
    EXPECT_EQ(plain.lengths, FrameLengths::absolute);
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "frame": "mik")")), "did you mean 'mikk'?");
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "lengths": "relativ")")), "did you mean 'relative'?");
    EXPECT_HAS(error_of(with_map(R"("file": "map.exr", "frame": "file", "lengths": "relative")")),
               "no lengths");
    const auto hash_scene = [&](const char* more) {
        return parse(with_map(R"("file": "map.exr")" + std::string(more))).hash;
    };
    EXPECT_NE(hash_scene(""), hash_scene(R"(, "frame": "dpdu")"));
    EXPECT_NE(hash_scene(""), hash_scene(R"(, "lengths": "relative")"));
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    const uint64_t hash = load_mesh_scene(folder_ / "plane.obj", options).hash;
    options.map.frame = "dpdu";
    const Scene scene = load_mesh_scene(folder_ / "plane.obj", options);
    EXPECT_EQ(scene.displacements[0].frame, FrameKind::dpdu);
    EXPECT_NE(scene.hash, hash);
}

TEST_F(SceneFiles, a_mesh_alone_is_framed_with_its_displacement) {
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    options.map.preset = "genvdm";
    const Scene flat = load_mesh_scene(folder_ / "plane.obj", {});
    options.map.scale = Vec3f{3, 3, 3};
    const Scene scene = load_mesh_scene(folder_ / "plane.obj", options);
    EXPECT_GT(scene.camera.from.z, 2.0f);
    EXPECT_GT(scene.camera.focus_distance, flat.camera.focus_distance + 0.5f);
    const float fill = measure_fill(flat.camera, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    EXPECT_NEAR(fill, 0.85f, 1e-3f);
    // The texel of 1 raises the top left quarter, that of 0.5 moves the bottom right one up.
    const float raised = measure_fill(
        scene.camera,
        {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 3}, {0, 1, 3}, {-1, 0, 3}, {0, 1.5f, 0}, {1, 1.5f, 0}});
    EXPECT_GT(raised, 0.79f);
    EXPECT_LT(raised, 0.91f);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_NE(scene.hash, flat.hash);
    options.map.axes = "t,q,b";
    EXPECT_HAS(message_of([&] { load_mesh_scene(folder_ / "plane.obj", options); }), "is no order of axes");
}

TEST_F(SceneFiles, a_mesh_alone_is_checked_before_it_is_framed) {
    std::string text = kQuadObj;
    const size_t at = text.find("vt ");
    ASSERT_NE(at, std::string::npos);
    write("far.obj", text.replace(at, text.find('\n', at) - at, "vt 1e39 0"));
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    EXPECT_HAS(message_of([&] { load_mesh_scene(folder_ / "far.obj", options); }), "far.obj");
    std::string wide = kQuadObj;
    write("wide.obj", wide.replace(0, wide.find('\n'), "v -1e19 -1 0"));
    EXPECT_HAS(message_of([&] { load_mesh_scene(folder_ / "wide.obj", {}); }), "is farther out than 1e+18");
}

TEST_F(SceneFiles, coding_errors_of_a_map_do_not_move_the_camera) {
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    options.map.preset = "genvdm";
    const Camera exact = load_mesh_scene(folder_ / "plane.obj", options).camera;
    write_pixels<float>("map.exr", 2, 2, 3, OIIO::TypeDesc::FLOAT,
                        {.002f, 0, .998f, 0, -.002f, .002f, 0, 0, 0, -.002f, .502f, 0});
    const Camera coarse = load_mesh_scene(folder_ / "plane.obj", options).camera;
    EXPECT_EQ(coarse.from, exact.from);
    EXPECT_EQ(coarse.to, exact.to);
}

TEST_F(SceneFiles, the_environment_of_a_mesh_alone_lights_visible_white_to_one) {
    MeshSceneOptions options;
    options.environment = folder_ / "sky.exr";
    const auto load_strength = [&](const std::vector<float>& texels) {
        write_pixels<float>("sky.exr", int(texels.size() / 3), 1, 3, OIIO::TypeDesc::FLOAT, texels);
        return load_mesh_scene(folder_ / "plane.obj", options).environment.value().strength;
    };
    EXPECT_NEAR(load_strength({20, 20, 20, 20, 20, 20}), 0.05f, 0.005f);
    EXPECT_EQ(load_strength({0, 0, 0, 0, 0, 0}), 1);
    // Four columns: the outer two are behind the camera, which looks along -z, and light what it sees.
    const float frontlit = load_strength({8, 8, 8, 0, 0, 0, 0, 0, 0, 8, 8, 8});
    const float backlit = load_strength({0, 0, 0, 8, 8, 8, 8, 8, 8, 0, 0, 0});
    EXPECT_NEAR(frontlit, backlit, 0.02f * backlit) << "turned to where the camera sees its light";
}

} // namespace relief
