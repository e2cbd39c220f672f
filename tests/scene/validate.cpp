#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "relief/error.h"
#include "relief/scene.h"

namespace relief {

namespace {

Scene make_scene() {
    Scene scene;
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_sizes = {4};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    scene.meshes.push_back(mesh);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->channel_count = 3;
    texture->floats = {0, 0, 0, 1};
    Displacement map;
    map.name = "ear";
    map.tiles.push_back({1001, texture});
    scene.displacements.push_back(map);
    scene.materials.emplace_back();
    Object object;
    object.name = "thing";
    object.displacement = object.material = 0;
    scene.objects.push_back(object);
    scene.lights.emplace_back();
    scene.environment = Environment{};
    return scene;
}

/// The message that the scene gets after `spoil`.
std::string complaint(const std::function<void(Scene&)>& spoil) {
    Scene scene = make_scene();
    spoil(scene);
    try {
        validate_scene(scene);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.what();
    }
    return "accepted";
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

} // namespace

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(ValidateScene, accepts_a_sound_scene) { EXPECT_NO_THROW(validate_scene(make_scene())); }

TEST(ValidateScene, tangents_are_finite_and_one_a_corner) {
    const auto set = [](size_t count, float z) {
        return complaint([=](Scene& scene) { scene.meshes[0].tangents.assign(count, {1, 0, z, -1}); });
    };
    EXPECT_EQ(set(4, 0), "accepted");
    EXPECT_HAS(set(3, 0), "has 3 tangents for 4 corners");
    EXPECT_HAS(set(4, kNan), "tangent 0 is not finite");
}

TEST(ValidateScene, names_the_object_with_a_bad_index_or_transform) {
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].mesh = 1; }), "object 'thing': mesh 1");
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].displacement = 7; }), "displacement 7");
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].material = 7; }), "material 7");
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].world_from_object.rows[1] = {}; }),
               "object 'thing': the transform");
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].world_from_object.translation.x = kNan; }),
               "singular or not finite");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].uv_indices.clear(); }), "mesh 'quad' has no uvs");
}

TEST(ValidateScene, refuses_what_lies_too_far_out_to_measure_distances) {
    const auto scale_by = [](Scene& s, float factor) {
        s.objects[0].world_from_object = make_scale({factor, factor, factor});
    };
    EXPECT_HAS(complaint([&](Scene& s) { scale_by(s, 1e38f); }), "object 'thing': the transform carries it");
    EXPECT_HAS(complaint([](Scene& s) { s.objects[0].world_from_object.translation.y = -2e18f; }),
               "object 'thing': the transform carries it");
    EXPECT_EQ(complaint([&](Scene& s) { scale_by(s, 1e17f); }), "accepted");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].positions[2].x = 2e18f; }),
               "mesh 'quad': position 2 is farther");
}

TEST(ValidateScene, names_the_mesh_with_bad_arrays) {
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].position_indices[2] = 4; }),
               "position index 4 of corner 2");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].uv_indices[0] = 9; }), "uv index 9");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].face_sizes[0] = 2; }), "2 corners");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].face_sizes[0] = 3; }),
               "4 position indices for 3 corners");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].positions[3].z = kNan; }), "position 3 is not finite");
    EXPECT_HAS(complaint([](Scene& s) { s.meshes[0].uvs[1].x = kNan; }), "uv 1 is not finite");
}

TEST(ValidateScene, refuses_maps_that_mean_nothing) {
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].tiles.clear(); }), "displacement 'ear'");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].tiles[0].texture = nullptr; }), "no texture");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].tiles[0].texture = std::make_shared<Texture>(); }),
               "0 x 0");
    const auto spread = [](Scene& s, size_t tiles) {
        s.displacements[0].is_udim = true;
        s.displacements[0].tiles.resize(tiles, s.displacements[0].tiles[0]);
    };
    EXPECT_EQ(complaint([&](Scene& s) { spread(s, 10000); }), "accepted");
    EXPECT_HAS(complaint([&](Scene& s) { spread(s, 10001); }), "has 10001 tiles");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].axes.axis = {0, 0, 2}; }), "no permutation");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].axes.sign[1] = 0; }), "sign");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].scale.y = kNan; }), "scale");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].frame = FrameKind(7); }), "frame is none of");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].filter = MapFilter(9); }), "is none of");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].dequantize = true; }), "needs a smooth filter");
    EXPECT_HAS(complaint([](Scene& s) {
                   s.displacements[0].dequantize = true, s.displacements[0].filter = MapFilter::cubic;
               }),
               "8 or 16-bit integers");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].wrap = WrapMode(9); }), "is none of");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].type = DisplacementType(9); }), "is none of");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].space = DisplacementSpace(9); }), "is none of");
    EXPECT_HAS(complaint([](Scene& s) { s.displacements[0].lengths = FrameLengths(-1); }), "lengths");
    EXPECT_HAS(complaint([](Scene& s) {
                   s.displacements[0].frame = FrameKind::file;
                   s.displacements[0].lengths = FrameLengths::relative;
               }),
               "no lengths");
}

TEST(ValidateScene, refuses_normal_maps_without_uvs_or_with_too_few_channels) {
    const auto add_map = [](Scene& s, uint32_t channel_count) {
        auto texture = std::make_shared<Texture>(*s.displacements[0].tiles[0].texture);
        texture->channel_count = channel_count;
        set_input_texture(s.materials[0], MaterialInput::normal, texture);
        s.objects[0].material = 0;
    };
    EXPECT_EQ(complaint([&](Scene& s) { add_map(s, 3); }), "accepted");
    EXPECT_HAS(complaint([&](Scene& s) { add_map(s, 1); }), "has 1 channels, and a normal has three");
    EXPECT_HAS(complaint([&](Scene& s) {
                   add_map(s, 3);
                   s.objects[0].displacement = kNoIndex;
                   s.meshes[0].uv_indices.clear();
               }),
               "mesh 'quad' has no uvs, which the normal_texture of its material needs");
    EXPECT_HAS(complaint([&](Scene& s) {
                   add_map(s, 3);
                   s.materials[0].textures[0].filter = MapFilter::mip;
               }),
               "filters are none, cubic and bspline");
}

TEST(ValidateScene, uv_sets_of_textures_are_those_of_the_mesh) {
    const auto put_on = [](int set, MaterialInput input = MaterialInput::roughness) {
        return [=](Scene& scene) {
            auto texture = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
            scene.materials[0].name = "steel";
            scene.materials[0].textures = {{.input = input, .tiles = {{1001, texture}}, .uv_set = set}};
            scene.meshes[0].further_uvs = {{4, {{0, 0}}, {0, 0, 0, 0}}};
        };
    };
    for (const int set : {kOwnUvSet, 0, 4}) EXPECT_EQ(complaint(put_on(set)), "accepted") << set;
    EXPECT_HAS(complaint(put_on(2)),
               "object 'thing': the specular_roughness of its material 'steel' lies on uv "
               "set 2, and mesh 'quad' has uv sets 0 and 4 (sets count from 0");
    EXPECT_HAS(complaint(put_on(256)),
               "material 'steel', specular_roughness: uv_set is 256, not in [0, 255]");
    EXPECT_HAS(complaint(put_on(-2)), "uv_set is -2");
    EXPECT_HAS(complaint(put_on(4, MaterialInput::normal)), "a normal map cannot have a uv_set");
    const auto with_sets = [](std::vector<UvSet> sets) {
        return [=](Scene& scene) { scene.meshes[0].further_uvs = sets; };
    };
    EXPECT_HAS(complaint(with_sets({{0, {{0, 0}}, {0, 0, 0, 0}}})),
               "mesh 'quad', uv set 0: there are two sets of this number");
    EXPECT_HAS(complaint(with_sets({{300, {{0, 0}}, {0, 0, 0, 0}}})), "uv set 300: the number is not in");
    EXPECT_HAS(complaint(with_sets({{1, {{0, 0}}, {0, 0, 0}}})), "uv set 1: has 3 uv indices for 4 corners");
    EXPECT_HAS(complaint(with_sets({{1, {{0, 0}}, {0, 0, 1, 0}}})), "uv index 1 of corner 2 is out of range");
    EXPECT_HAS(complaint(with_sets({{1, {{0, kNan}}, {0, 0, 0, 0}}})), "uv set 1: uv 0 is not finite");
    EXPECT_HAS(complaint([](Scene& scene) { scene.meshes[0].uv_set = -1; }),
               "the number of its uv set is -1");
}

TEST(ValidateScene, refuses_anisotropy_without_uvs_or_with_too_many_textures) {
    const auto without_uvs = [](const auto& change) {
        return complaint([&](Scene& s) {
            s.objects[0].material = 0, s.objects[0].displacement = kNoIndex;
            s.meshes[0].uv_indices.clear();
            change(s.materials[0]);
        });
    };
    EXPECT_EQ(without_uvs([](Material& m) { m.coat_roughness_anisotropy = 1; }), "accepted");
    EXPECT_HAS(without_uvs([](Material& m) { m.specular_roughness_anisotropy = 0.1f; }),
               "mesh 'quad' has no uvs, which the specular_roughness_anisotropy of its material needs");
    EXPECT_HAS(without_uvs([](Material& m) { m.coat_weight = m.coat_roughness_anisotropy = 1; }),
               "mesh 'quad' has no uvs, which the coat_roughness_anisotropy of its material needs");
    const auto with_textures = [](float anisotropy) {
        return complaint([&](Scene& s) {
            s.materials[0].specular_roughness_anisotropy = anisotropy;
            const auto texture = s.displacements[0].tiles[0].texture;
            for (const auto input :
                 {MaterialInput::roughness, MaterialInput::coat_weight, MaterialInput::fuzz_weight})
                s.materials[0].textures.push_back({.input = input, .tiles = {{1001, texture}}});
        });
    };
    EXPECT_EQ(with_textures(0), "accepted");
    EXPECT_HAS(with_textures(0.5f), "and at most 2 may beside an anisotropy");
}

TEST(ValidateScene, refuses_glass_under_layers_and_clear_walls_that_glow) {
    const auto of_glass = [](const auto& change) {
        return complaint([&](Scene& s) {
            s.materials[0].transmission_weight = 0.5f;
            change(s.materials[0]);
        });
    };
    EXPECT_EQ(of_glass([](Material&) {}), "accepted");
    EXPECT_HAS(of_glass([](Material& m) { m.coat_weight = 0.1f; }),
               "transmission_weight and coat_weight exclude each other");
    EXPECT_HAS(of_glass([](Material& m) { m.fuzz_weight = 0.1f; }),
               "transmission_weight and fuzz_weight exclude each other");
    const auto glow = [](Material& m, float roughness) {
        m.emission = {1, 1, 1}, m.is_thin_walled = true, m.roughness = roughness;
    };
    EXPECT_HAS(of_glass([&](Material& m) { glow(m, 0.01f); }), "transmission_weight and emission exclude");
    EXPECT_EQ(of_glass([&](Material& m) { glow(m, 0.1f); }), "accepted");
}

TEST(ValidateScene, refuses_values_out_of_range) {
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].roughness = 1.5f; }), "roughness is 1.5");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].ior = 0.5f; }), "ior");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].base_weight = 2; }), "base_weight is 2");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].base_diffuse_roughness = -1; }),
               "base_diffuse_roughness");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].specular_weight = kNan; }), "specular_weight");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].specular_color.y = 2; }), "specular_color");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].specular_roughness_anisotropy = 2; }),
               "specular_roughness_anisotropy is 2");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_roughness_anisotropy = kNan; }),
               "coat_roughness_anisotropy");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_weight = 2; }), "coat_weight");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_color.z = -1; }), "coat_color");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_roughness = 2; }), "coat_roughness");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_ior = 0.9f; }), "coat_ior");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].coat_darkening = 2; }), "coat_darkening");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].fuzz_weight = 2; }), "fuzz_weight");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].fuzz_color.x = 2; }), "fuzz_color");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].fuzz_roughness = 2; }), "fuzz_roughness");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].opacity = 2; }), "opacity");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].normal_scale = -1; }),
               "scale of normal_texture is -1");
    EXPECT_HAS(complaint([](Scene& s) {
                   s.materials[0].opacity = 0.5f, s.materials[0].emission = {1, 0, 0};
               }),
               "opacity and emission exclude each other");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].transmission_weight = 2; }),
               "transmission_weight is 2");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].transmission_color.y = -1; }), "transmission_color");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].transmission_depth = kNan; }), "transmission_depth");
    EXPECT_HAS(complaint([](Scene& s) { s.lights[0].direction = {}; }), "light 0: direction");
    EXPECT_HAS(complaint([](Scene& s) { s.lights[0].strength = -1; }), "light 0: strength");
    EXPECT_HAS(complaint([](Scene& s) { s.lights[0].light_group = "a b"; }), "no name of a light group");
    EXPECT_HAS(complaint([](Scene& s) { s.materials[0].light_group = "a.b"; }), "no name of a light group");
    EXPECT_HAS(complaint([](Scene& s) { s.environment->light_group = ","; }), "no name of a light group");
    EXPECT_HAS(complaint([](Scene& s) { s.environment->strength = kNan; }), "environment");
    EXPECT_HAS(complaint([](Scene& s) { s.camera.to = s.camera.from; }), "same point");
    EXPECT_HAS(complaint([](Scene& s) { s.camera.up = {0, 0, 1}; }), "'up'");
    EXPECT_HAS(complaint([](Scene& s) { s.camera.fov_degrees = 180; }), "fov_degrees");
    EXPECT_HAS(complaint([](Scene& s) { s.picture.spp = -1; }), "spp is -1");
    EXPECT_HAS(complaint([](Scene& s) { s.picture.width = 70000; }), "width");
    EXPECT_HAS(complaint([](Scene& s) { s.picture.bounces = 1001; }), "bounces is 1001, not in [0, 1000]");
    EXPECT_EQ(complaint([](Scene& s) { s.picture.bounces = 1000; }), "accepted");
}

/// The message for one light.
std::string complain_of(const Light& light) {
    return complaint([&](Scene& scene) { scene.lights = {light}; });
}

TEST(ValidateScene, lights_need_the_extent_that_their_type_has) {
    using enum LightType;
    for (LightType type : {sun, point, rectangle, spot}) EXPECT_EQ(complain_of({.type = type}), "accepted");
    EXPECT_HAS(complain_of({.type = disk}), "light 0: radius is 0");
    EXPECT_HAS(complain_of({.type = disk}), "needs a radius above 0");
    EXPECT_EQ(complain_of({.type = disk, .radius = 0.1f}), "accepted");
    EXPECT_HAS(complain_of({.type = rectangle, .width = 0}), "light 0: width is 0");
    EXPECT_HAS(complain_of({.type = rectangle, .height = -1}), "light 0: height is -1");
    EXPECT_HAS(complain_of({.type = rectangle, .up = {}}), "light 0: up has no length");
    EXPECT_HAS(complain_of({.type = rectangle, .direction = {}}), "light 0: direction has no length");
    EXPECT_HAS(complain_of({.type = spot, .direction = {kNan, 0, 0}}), "light 0: direction");
    EXPECT_HAS(complain_of({.type = spot, .cone_degrees = 0}), "angle of its cone is 0, not in (0, 180]");
    EXPECT_HAS(complain_of({.type = spot, .cone_degrees = 181}), "angle of its cone is 181");
    EXPECT_HAS(complain_of({.type = spot, .blend = 1.5f}), "light 0: blend is 1.5");
    EXPECT_HAS(complain_of({.type = spot, .radius = -1}), "light 0: radius is -1");
    EXPECT_HAS(complain_of({.type = LightType(9)}), "type 9 is none of LightType");
}

TEST(ValidateScene, cameras_see_only_lights_with_extent) {
    using enum LightType;
    EXPECT_HAS(complain_of({.type = point, .is_visible_to_camera = true}), "(give it a radius)");
    EXPECT_HAS(complain_of({.type = spot, .is_visible_to_camera = true}), "without extent cannot be seen");
    EXPECT_HAS(complain_of({.angle_degrees = 0, .is_visible_to_camera = true}),
               "(give it angle_degrees above");
    EXPECT_EQ(complain_of({.is_visible_to_camera = true}), "accepted");
    for (LightType type : {point, rectangle, disk, spot})
        EXPECT_EQ(complain_of({.type = type, .radius = 1, .is_visible_to_camera = true}), "accepted");
}

} // namespace relief
