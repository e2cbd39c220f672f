// Materials of scene files: names, numbers and textures.
#include <cmath>
#include <string>
#include <vector>

#include "io/scene_files.h"
#include "relief/io.h"
#include "support/input_textures.h"

namespace relief {

TEST_F(SceneFiles, materials_have_the_names_of_open_pbr) {
    const char* const text = R"({"materials": {"a": {"base_weight": 0.1, "base_color": [0.2, 0.3, 0.4],
        "base_diffuse_roughness": 0.5, "base_metalness": 0.6, "specular_weight": 0.7,
        "specular_color": [0.8, 0.9, 1], "specular_roughness": 0.11, "specular_ior": 1.2, "coat_weight": 0.13,
        "specular_roughness_anisotropy": 0.31, "coat_roughness_anisotropy": 0.32,
        "coat_color": [0.14, 0.15, 0.16], "coat_roughness": 0.17, "coat_ior": 1.8, "coat_darkening": 0.19,
        "fuzz_weight": 0.2, "fuzz_color": [0.21, 0.22, 0.23], "fuzz_roughness": 0.24, "emission_luminance": 4,
        "emission_color": [1, 0.5, 0.25]}}})";
    Scene scene = parse(text);
    for (int round = 0; round < 2; ++round) {
        const Material& m = scene.materials.at(0);
        EXPECT_EQ(m.base_weight, 0.1f);
        EXPECT_EQ(m.base_color, (Vec3f{0.2f, 0.3f, 0.4f}));
        EXPECT_EQ(m.base_diffuse_roughness, 0.5f);
        EXPECT_EQ(m.metallic, 0.6f);
        EXPECT_EQ(m.specular_weight, 0.7f);
        EXPECT_EQ(m.specular_color, (Vec3f{0.8f, 0.9f, 1}));
        EXPECT_EQ(m.roughness, 0.11f);
        EXPECT_EQ(m.ior, 1.2f);
        EXPECT_EQ(m.coat_weight, 0.13f);
        EXPECT_EQ(m.coat_color, (Vec3f{0.14f, 0.15f, 0.16f}));
        EXPECT_EQ(m.coat_roughness, 0.17f);
        EXPECT_EQ(m.specular_roughness_anisotropy, 0.31f);
        EXPECT_EQ(m.coat_roughness_anisotropy, 0.32f);
        EXPECT_EQ(m.coat_ior, 1.8f);
        EXPECT_EQ(m.coat_darkening, 0.19f);
        EXPECT_EQ(m.fuzz_weight, 0.2f);
        EXPECT_EQ(m.fuzz_color, (Vec3f{0.21f, 0.22f, 0.23f}));
        EXPECT_EQ(m.fuzz_roughness, 0.24f);
        EXPECT_EQ(m.emission, (Vec3f{4, 2, 1}));
        // The same once more, written and read again.
        scene.meshes.push_back(parse(with_object("")).meshes.at(0));
        scene.objects.push_back({.name = "o", .mesh = 0, .material = 0});
        save_scene(scene, folder_ / "layers");
        scene = load_scene(folder_ / "layers" / "scene.json");
    }
}

TEST_F(SceneFiles, a_material_says_each_number_under_one_name) {
    const auto of_material = [&](const std::string& keys) {
        return error_of(R"({"materials": {"m": {)" + keys + "}}}");
    };
    EXPECT_EQ(
        of_material(R"("roughness": 1, "specular_roughness": 1)"),
        "s.json: materials.m.specular_roughness: means the same as 'roughness', which is there too (leave "
        "one of the two out)");
    EXPECT_HAS(of_material(R"("metallic": 1, "base_metalness": 0)"),
               "materials.m.base_metalness: means the same");
    EXPECT_HAS(of_material(R"("specular_ior": 1.5, "ior": 1.5)"), "materials.m.specular_ior: means the same");
    EXPECT_HAS(of_material(R"("emission": [1, 1, 1], "emission_luminance": 1)"), "emission_luminance: means");
    EXPECT_HAS(of_material(R"("emission": [1, 1, 1], "emission_color": [1, 1, 1])"), "emission_color: means");
    EXPECT_HAS(of_material(R"("emission_color": [1, 1, 1])"), "emission_luminance, which is not there");
    EXPECT_HAS(of_material(R"("coat_weight": 1.5)"), "materials.m.coat_weight: must be in [0, 1], not 1.5");
    EXPECT_HAS(of_material(R"("opacity": 1, "geometry_opacity": 1)"), "geometry_opacity: means the same");
    EXPECT_HAS(of_material(R"("opacity": -1)"), "materials.m.opacity: must be in [0, 1]");
    EXPECT_HAS(of_material(R"("coat_ior": 0.5)"), "materials.m.coat_ior: must be at least 1");
    EXPECT_HAS(of_material(R"("fuzz_color": [0, 0, 2])"), "materials.m.fuzz_color[2]");
    EXPECT_HAS(of_material(R"("specular_roughness_anisotropy": 1.5)"),
               "materials.m.specular_roughness_anisotropy: must be in [0, 1], not 1.5");
    EXPECT_HAS(of_material(R"("coat_roughness_anisotropy": {"file": "a.png"})"),
               "materials.m.coat_roughness_anisotropy: cannot have a texture");
    for (const char* later :
         {"transmission_scatter", "subsurface_weight", "geometry_tangent", "thin_film_weight"})
        EXPECT_HAS(of_material(std::string("\"") + later + R"(": 0.5)"),
                   std::string("materials.m.") + later + ": this input of OpenPBR is not rendered");
}

TEST_F(SceneFiles, normal_maps_are_read_as_they_are) {
    write_pixels<uint8_t>("normal.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0});
    write_pixels<uint8_t>("grey.png", 1, 1, 1, OIIO::TypeDesc::UINT8, {128});
    write_pixels<float>("nan.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0, NAN, 1});
    const auto with_material = [](const std::string& members) {
        return R"({"materials": {"m": {)" + members + "}}}";
    };
    const Scene scene = parse(with_material(R"("normal_texture": {"file": "normal.png", "filter": "cubic",
                                                                  "scale": 2, "flip_y": true})"));
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(test::get_texture(material, MaterialInput::normal)->floats,
              (std::vector<float>{1, 128 / 255.f, 0, 0}));
    EXPECT_EQ(test::get_filter(material, MaterialInput::normal), MapFilter::cubic);
    EXPECT_EQ(material.normal_scale, 2);
    EXPECT_TRUE(material.normal_flip_y);
    EXPECT_EQ(test::get_texture(parse(with_material(R"("geometry_normal": "normal.png")")).materials.at(0),
                                MaterialInput::normal)
                  ->floats,
              test::get_texture(material, MaterialInput::normal)->floats);
    EXPECT_HAS(error_of(with_material(R"("geometry_normal": "normal.png", "normal_texture": "normal.png")")),
               "means the same as 'normal_texture'");
    EXPECT_HAS(error_of(with_material(R"("normal_texture": {"file": "normal.png", "channel": "g"})")),
               "channel");
    EXPECT_HAS(error_of(with_material(R"("normal_texture": {"file": "normal.png", "scale": -1})")), "scale");
    EXPECT_HAS(error_of(with_material(R"("normal_texture": {"scale": 1})")), "file");
    EXPECT_HAS(error_of(with_material(R"("normal_texture": "grey.png")")), "normal has three");
    EXPECT_HAS(error_of(with_material(R"("normal_texture": "nan.exr")")), "NaN in channel G");
}

} // namespace relief
