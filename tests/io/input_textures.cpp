// Textures of any input of a material in scene files: read, written and read again, refused.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/scene_files.h"
#include "relief/io.h"
#include "scene/material_inputs.h"

namespace relief {
namespace {

class InputTextures : public SceneFiles {
  protected:
    InputTextures() {
        write_pixels<uint8_t>("colors.png", 2, 1, 4, OIIO::TypeDesc::UINT8,
                              {255, 0, 51, 102, 0, 255, 153, 204});
        write_pixels<float>("grey.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {0.25f});
        write_pixels<float>("t.1001.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {0.5f});
        write_pixels<float>("t.1012.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {0.75f});
        write_pixels<float>("n.1001.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0.5f, 0.5f, 1});
        write_pixels<float>("nan.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0, NAN, 1});
    }
    static std::string with_material(const std::string& members) {
        return R"({"materials": {"m": {)" + members + "}}}";
    }
    Material read(const std::string& members) const { return parse(with_material(members)).materials.at(0); }
    std::string refuse(const std::string& members) const { return error_of(with_material(members)); }
};

std::vector<float> find_first_channel(const InputTexture& texture) {
    std::vector<float> values;
    for (const MapTile& tile : texture.tiles)
        for (uint32_t y = 0; y < tile.texture->height; ++y)
            for (uint32_t x = 0; x < tile.texture->width; ++x)
                values.push_back(tile.texture->floats.at(tile.texture->find_texel(x, y)));
    return values;
}

TEST_F(InputTextures, stand_in_place_of_each_number_and_color) {
    for (const MaterialInputKind& kind : list_material_inputs()) {
        if (kind.input == MaterialInput::normal) continue;
        for (const char* key : {kind.name, kind.alias}) {
            if (!key) continue;
            const std::string name = key;
            std::string members = "\"" + name + R"(": {"file": "grey.exr", "factor": 0.5})";
            if (name == "emission_color") members += R"(, "emission_luminance": 1)";
            const Material material = read(members);
            ASSERT_EQ(material.textures.size(), 1u) << name;
            EXPECT_EQ(material.textures[0].input, kind.input) << name;
            EXPECT_EQ(find_first_channel(material.textures[0]), std::vector<float>{0.25f}) << name;
            if (kind.number) EXPECT_EQ(material.*kind.number, 0.5f) << name;
            if (kind.color) EXPECT_EQ(material.*kind.color, (Vec3f{0.5f, 0.5f, 0.5f})) << name;
            if (name == "emission_color") continue;
            const Material whole = read("\"" + name + R"(": {"file": "grey.exr"})");
            if (kind.number) EXPECT_EQ(whole.*kind.number, 1) << name;
            if (kind.color) EXPECT_EQ(whole.*kind.color, (Vec3f{1, 1, 1})) << name;
        }
    }
}

TEST_F(InputTextures, pick_a_channel_in_a_color_space) {
    const auto values_of = [&](const std::string& members) {
        return find_first_channel(
            read(R"("coat_weight": {"file": "colors.png")" + members + "}").textures.at(0));
    };
    EXPECT_EQ(values_of(""), (std::vector<float>{1, 0}));
    EXPECT_EQ(values_of(R"(, "channel": "g")"), (std::vector<float>{0, 1}));
    const std::vector<float> alpha = values_of(R"(, "channel": "a")");
    EXPECT_FLOAT_EQ(alpha.at(0), 102 / 255.f);
    EXPECT_FLOAT_EQ(alpha.at(1), 204 / 255.f);
    const std::vector<float> luminance = values_of(R"(, "channel": "luminance")");
    EXPECT_NEAR(luminance.at(0), 0.2126f + 0.0722f * 0.2f, 1e-6f);
    EXPECT_NEAR(luminance.at(1), 0.7152f + 0.0722f * 0.6f, 1e-6f);
    const float decoded = std::pow((0.2f + 0.055f) / 1.055f, 2.4f);
    EXPECT_NEAR(values_of(R"(, "channel": "b", "color_space": "srgb")").at(0), decoded, 1e-6f);
    // A colour is decoded, one of its channels in its place is not.
    const Material colors = read(R"("coat_color": {"file": "colors.png"},
                                    "fuzz_color": {"file": "colors.png", "channel": "b"})");
    EXPECT_NEAR(colors.textures.at(0).tiles.at(0).texture->floats.at(2), decoded, 1e-6f);
    const Texture& grey = *colors.textures.at(1).tiles.at(0).texture;
    EXPECT_EQ(grey.channel_count, 1u);
    EXPECT_FLOAT_EQ(grey.floats.at(0), 0.2f);
    EXPECT_EQ(
        find_first_channel(
            read(R"("roughness_texture": {"file": "colors.png", "channel": "luminance"})").textures.at(0)),
        luminance);
}

TEST_F(InputTextures, of_their_own_keys_are_those_of_the_inputs) {
    for (const MaterialInputKind& kind : list_material_inputs()) {
        if (!kind.texture_key || kind.input == MaterialInput::normal) continue;
        const auto read_key = [&](const std::string& key, const std::string& file) {
            return read("\"" + key + R"(": {"file": ")" + file + R"(", "filter": "cubic"})").textures;
        };
        for (const char* file : {"colors.png", "grey.exr"}) {
            const std::vector<InputTexture> own = read_key(kind.texture_key, file),
                                            placed = read_key(kind.short_name(), file);
            ASSERT_EQ(own.size(), 1u) << kind.texture_key;
            EXPECT_EQ(own[0].input, kind.input);
            EXPECT_EQ(own[0].filter, MapFilter::cubic) << kind.texture_key;
            EXPECT_EQ(own[0].tiles[0].texture->floats, placed.at(0).tiles[0].texture->floats) << file;
            EXPECT_EQ(own[0].tiles[0].texture->halves, placed[0].tiles[0].texture->halves) << file;
            EXPECT_EQ(find_input_texture(read("\"" + std::string(kind.texture_key) + "\": \"" + file + "\""),
                                         kind.input)
                          ->filter,
                      MapFilter::none);
        }
        EXPECT_HAS(refuse("\"" + std::string(kind.texture_key) + R"(": "nan.exr")"), "NaN in channel G");
    }
}

TEST_F(InputTextures, are_written_and_read_again) {
    Scene scene = parse(with_material(R"("base_color": {"file": "colors.png", "factor": [0.5, 0.25, 1]},
        "roughness": {"file": "t.<UDIM>.exr", "uv_scale": 2, "filter": "cubic"},
        "opacity": {"file": "grey.exr", "uv_scale": [2, 3], "uv_offset": [0.5, -1], "wrap": "mirror"},
        "coat_weight": {"file": "grey.exr", "wrap": "black", "filter": "bspline"},
        "geometry_normal": {"file": "n.<UDIM>.exr", "scale": 2, "uv_offset": 0.5})"));
    const Scene glowing = parse(with_material(R"("emission_luminance": {"file": "grey.exr", "factor": 4},
        "emission_color": {"file": "colors.png", "factor": [1, 0.5, 0.25]})"));
    scene.materials.push_back(glowing.materials.at(0));
    scene.materials.push_back(read(R"("emission": {"file": "colors.png", "factor": [4, 2, 1]})"));
    scene.meshes.push_back(parse(with_object("")).meshes.at(0));
    scene.objects.push_back({.name = "o", .mesh = 0, .material = 0});
    save_scene(scene, folder_ / "saved");
    const Scene again = load_scene(folder_ / "saved" / "scene.json");
    ASSERT_EQ(again.materials.size(), 3u);
    for (size_t k = 0; k < 3; ++k) {
        const Material &a = scene.materials[k], &b = again.materials[k];
        ASSERT_EQ(a.textures.size(), b.textures.size());
        for (size_t n = 0; n < a.textures.size(); ++n) {
            const InputTexture &x = a.textures[n], &y = b.textures[n];
            SCOPED_TRACE(get_input_name(x.input));
            EXPECT_EQ(x.input, y.input);
            EXPECT_EQ(x.is_udim, y.is_udim);
            EXPECT_EQ(x.filter, y.filter);
            EXPECT_EQ(x.wrap, y.wrap);
            EXPECT_EQ(x.uv_scale, y.uv_scale);
            EXPECT_EQ(x.uv_offset, y.uv_offset);
            EXPECT_EQ(find_first_channel(x), find_first_channel(y));
            ASSERT_EQ(x.tiles.size(), y.tiles.size());
            for (size_t t = 0; t < x.tiles.size(); ++t) EXPECT_EQ(x.tiles[t].udim, y.tiles[t].udim);
        }
        for (const MaterialInputKind& kind : list_material_inputs()) {
            if (kind.number) EXPECT_EQ(a.*kind.number, b.*kind.number) << kind.name;
            if (kind.color) EXPECT_EQ(a.*kind.color, b.*kind.color) << kind.name;
        }
        EXPECT_EQ(a.normal_scale, b.normal_scale);
    }
    EXPECT_EQ(scene.materials[0].normal_scale, 2);
    EXPECT_EQ(scene.materials[0].textures.size(), 5u);
    EXPECT_EQ(scene.materials[1].emission, (Vec3f{4, 2, 1}));
}

TEST_F(InputTextures, have_tiles_under_the_keys_of_textures_too) {
    const Material material = read(R"("roughness_texture": "t.<UDIM>.exr", "roughness": 0.5,
        "normal_texture": {"file": "n.<UDIM>.exr", "flip_y": true})");
    ASSERT_EQ(material.textures.size(), 2u);
    EXPECT_EQ(material.textures[0].input, MaterialInput::roughness);
    EXPECT_EQ(find_first_channel(material.textures[0]), (std::vector<float>{0.5f, 0.75f}));
    EXPECT_EQ(material.textures[0].tiles[1].udim, 1012);
    EXPECT_EQ(material.roughness, 0.5f);
    EXPECT_EQ(material.textures[1].input, MaterialInput::normal);
    EXPECT_TRUE(material.normal_flip_y);
}

TEST_F(InputTextures, are_refused_by_name_where_they_cannot_be) {
    const auto with_keys = [&](const std::string& keys) {
        return refuse(R"("coat_weight": {"file": "grey.exr", )" + keys + "}");
    };
    EXPECT_HAS(with_keys(R"("uv_set": 256)"), "materials.m.coat_weight.uv_set: must be in [0, 255], not 256");
    EXPECT_HAS(with_keys(R"("uv_set": -1)"), "coat_weight.uv_set: must be in [0, 255], not -1");
    EXPECT_EQ(refuse(R"("geometry_normal": {"file": "n.1001.exr", "uv_set": 1})"),
              "s.json: materials.m.geometry_normal.uv_set: directions of a normal map go by the uvs that the "
              "mesh is read with (name its set as uv_set of the mesh, and the other one as that of the other "
              "textures)");
    EXPECT_HAS(with_keys(R"("channel": "x")"), "coat_weight.channel: unknown channel 'x'");
    EXPECT_HAS(with_keys(R"("channel": "a")"), "no channel a: there are 1");
    EXPECT_HAS(with_keys(R"("color_space": "nope")"), "nope");
    EXPECT_HAS(with_keys(R"("wrap": "around")"), "around");
    EXPECT_HAS(with_keys(R"("filter": "mip")"), "filter mip is for displacement maps");
    EXPECT_HAS(with_keys(R"("uv_scale": [1, 2, 3])"), "uv_scale: must be 2 numbers, not 3");
    EXPECT_HAS(with_keys(R"("uv_offset": 1e9)"), "uv_offset");
    EXPECT_HAS(with_keys(R"("factor": 2)"), "coat_weight.factor: must be in [0, 1], not 2");
    EXPECT_HAS(with_keys(R"("flip_y": true)"), "flip_y");
    EXPECT_HAS(refuse(R"("coat_color": {"file": "grey.exr", "factor": [1, 2, 0]})"), "factor[1]");
    EXPECT_HAS(refuse(R"("coat_weight": {"factor": 1})"), "file");
    EXPECT_HAS(refuse(R"("coat_weight": {"file": "none.exr"})"), "none.exr");
    EXPECT_HAS(refuse(R"("coat_weight": {"file": "none.<UDIM>.exr"})"), "no tile file found");
    EXPECT_HAS(refuse(R"("coat_weight": {"file": "nan.exr"})"), "NaN in channel G");
    EXPECT_HAS(refuse(R"("coat_weight": {"file": "t.<UDIM>.exr", "wrap": "clamp"})"), "leave wrap out");
    EXPECT_HAS(refuse(R"("coat_ior": {"file": "grey.exr"})"), "materials.m.coat_ior: cannot have a texture");
    EXPECT_HAS(refuse(R"("ior": {"file": "grey.exr"})"), "texture specular_weight");
    EXPECT_HAS(refuse(R"("specular_ior": {"file": "grey.exr"})"), "cannot have a texture");
    EXPECT_HAS(refuse(R"("transmission_depth": {"file": "grey.exr"})"), "inside of a body");
    EXPECT_HAS(refuse(R"("roughness": {"file": "grey.exr"}, "roughness_texture": "grey.exr")"),
               "has a texture twice: 'roughness_texture' is there too");
    EXPECT_HAS(refuse(R"("roughness_texture": {"file": "grey.exr", "wrap": "clamp"})"), "wrap");
    EXPECT_HAS(refuse(R"("transmission_weight": 1, "specular_weight": {"file": "grey.exr"})"),
               "ior that changes over its surface");
    EXPECT_HAS(refuse(R"("transmission_weight": 1, "transmission_depth": 1,
                         "transmission_color": {"file": "grey.exr"})"),
               "colour of the inside");
    EXPECT_HAS(refuse(R"("coat_weight": {"file": "grey.exr"}, "coat_roughness": {"file": "grey.exr"},
                         "fuzz_weight": {"file": "grey.exr"}, "fuzz_roughness": {"file": "grey.exr"},
                         "roughness_texture": "grey.exr")"),
               "5 of the numbers that the albedo of its layers depends on have textures, and at most 4 may");
    EXPECT_HAS(refuse(R"("opacity": {"file": "grey.exr"}, "emission": [1, 1, 1])"), "exclude each other");
    EXPECT_HAS(refuse(R"("geometry_normal": {"file": "grey.exr", "uv_scale": 2})"), "normal has three");
}

TEST_F(InputTextures, of_scenes_in_memory_are_checked) {
    Scene scene = parse(with_object(""));
    scene.materials = {read(R"("coat_weight": {"file": "grey.exr"})")};
    const InputTexture good = scene.materials[0].textures[0];
    const auto refuse_texture = [&](const auto& change) {
        scene.materials[0].textures = {good};
        change(scene.materials[0].textures[0]);
        return message_of([&] { validate_scene(scene); });
    };
    EXPECT_NO_THROW(validate_scene(scene));
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.input = MaterialInput(99); }),
               "input 99, which there is not");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.tiles.clear(); }), "has 0 tiles");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.tiles[0].texture = nullptr; }), "has no texture");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.is_udim = true, t.tiles[0].udim = 12; }),
               "tile 12 is not in");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.is_udim = true, t.tiles.push_back(t.tiles[0]); }),
               "twice");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.filter = MapFilter::mip; }), "wrap or filter");
    EXPECT_HAS(refuse_texture([](InputTexture& t) { t.uv_scale.x = NAN; }), "uv_scale is nan");
    scene.materials[0].textures = {good, good};
    EXPECT_HAS(message_of([&] { validate_scene(scene); }), "coat_weight: has a texture twice");
    auto bad = std::make_shared<Texture>(*good.tiles[0].texture);
    bad->floats[3] = INFINITY;
    EXPECT_HAS(refuse_texture([&](InputTexture& t) { t.tiles[0].texture = bad; }), "no finite number");
}

} // namespace
} // namespace relief
