// Layers and parts of EXR files: which one maps, textures and environments read, and what is said of the
// others.
#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "io/test_files.h"
#include "relief/io.h"
#include "support/input_textures.h"

namespace relief {

namespace {

constexpr int kSide = 4;

/// Channels and the value that all of their pixels have.
using Channels = std::vector<std::pair<std::string, float>>;

} // namespace

class ExrLayers : public FileTest {
  protected:
    static void add(const Channels& channels, Imf::Header& header, Imf::FrameBuffer& buffer,
                    std::vector<std::vector<float>>& values) {
        values.reserve(channels.size());
        for (const auto& [name, value] : channels) {
            values.emplace_back(size_t(kSide * kSide), value);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            buffer.insert(
                name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.back().data()), 4, 4 * kSide));
        }
    }

    std::filesystem::path write_exr(const std::string& name, const Channels& channels,
                                    Imf::Header header = Imf::Header(kSide, kSide)) const {
        Imf::FrameBuffer buffer;
        std::vector<std::vector<float>> values;
        add(channels, header, buffer, values);
        Imf::OutputFile output((folder_ / name).c_str(), header, 0);
        output.setFrameBuffer(buffer);
        output.writePixels(kSide);
        return folder_ / name;
    }

    std::filesystem::path write_parts(const std::string& name,
                                      const std::vector<std::pair<std::string, Channels>>& parts) const {
        std::vector<Imf::Header> headers;
        std::vector<Imf::FrameBuffer> buffers(parts.size());
        std::vector<std::vector<std::vector<float>>> values(parts.size());
        for (size_t k = 0; k < parts.size(); ++k) {
            Imf::Header header(kSide, kSide);
            header.setName(parts[k].first), header.setType(Imf::SCANLINEIMAGE);
            add(parts[k].second, header, buffers[k], values[k]);
            headers.push_back(header);
        }
        Imf::MultiPartOutputFile file((folder_ / name).c_str(), headers.data(), int(headers.size()));
        for (size_t k = 0; k < parts.size(); ++k) {
            Imf::OutputPart part(file, int(k));
            part.setFrameBuffer(buffers[k]);
            part.writePixels(kSide);
        }
        return folder_ / name;
    }

    /// The first texel's channels.
    static std::vector<float> first(const Texture& texture) {
        return {texture.floats.begin(), texture.floats.begin() + std::min(4u, texture.channel_count)};
    }
    static std::vector<float> read_first(const std::string& name) { return first(read_texture(name)); }
};

TEST_F(ExrLayers, of_one_part_are_chosen_by_name) {
    const std::string file = write_exr("layers.exr", {{"beauty.R", 1},
                                                      {"beauty.G", 2},
                                                      {"beauty.B", 3},
                                                      {"vdm.R", 4},
                                                      {"vdm.G", 5},
                                                      {"vdm.B", 6},
                                                      {"vdm.Z", 7}})
                                 .string();
    EXPECT_EQ(read_first(file + ":vdm"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(file + ":beauty"), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(file + ":vdm.Z"), (std::vector<float>{7}));
    EXPECT_TRUE(read_texture(file + ":vdm").warnings.empty());
    const Texture usual = read_texture(file);
    EXPECT_EQ(first(usual), (std::vector<float>{1, 2, 3}));
    ASSERT_EQ(usual.warnings.size(), 1u);
    EXPECT_HAS(usual.warnings[0], "reads layer 'beauty' (R G B) and leaves out layer 'vdm' (R G B Z): name");
    EXPECT_HAS(usual.warnings[0], "layers.exr:vdm,");
    const std::string message = message_of([&] { read_texture(file + ":vdn"); });
    EXPECT_HAS(message, "has no layer 'vdn'");
    EXPECT_HAS(message, "layer 'vdm' (R G B Z)");
}

TEST_F(ExrLayers, without_a_name_come_before_others_and_alpha_is_none) {
    const std::string plain = write_exr("plain.exr", {{"A", 1}, {"B", 4}, {"G", 3}, {"R", 2}}).string();
    EXPECT_EQ(read_first(plain), (std::vector<float>{2, 3, 4, 1}));
    EXPECT_TRUE(read_texture(plain).warnings.empty());
    const std::string file =
        write_exr("depth.exr", {{"B", 4}, {"G", 3}, {"R", 2}, {"Z", 9}, {"a.X", 1}, {"a.Y", 1}, {"a.Z", 1}})
            .string();
    const Texture texture = read_texture(file);
    EXPECT_EQ(first(texture), (std::vector<float>{2, 3, 4})) << "depth is no fourth channel";
    ASSERT_EQ(texture.warnings.size(), 1u);
    EXPECT_HAS(texture.warnings[0], "leaves out channels Z, layer 'a' (X Y Z)");
    EXPECT_EQ(read_first(file + ":Z"), (std::vector<float>{9}));
}

TEST_F(ExrLayers, have_their_channels_in_the_order_of_their_names) {
    EXPECT_EQ(read_first(write_exr("tbn.exr", {{"B", 2}, {"N", 3}, {"T", 1}}).string()),
              (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(write_exr("xyz.exr", {{"d.z", 3}, {"d.x", 1}, {"d.y", 2}}).string()),
              (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(write_exr("uvw.exr", {{"W", 3}, {"V", 2}, {"U", 1}}).string()),
              (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(write_exr("rgb.exr", {{"m.b", 3}, {"m.g", 2}, {"m.r", 1}}).string()),
              (std::vector<float>{1, 2, 3}));
}

TEST_F(ExrLayers, of_parts_are_chosen_by_part_and_layer) {
    const std::string file =
        write_parts("parts.exr", {{"beauty", {{"B", 3}, {"G", 2}, {"R", 1}}},
                                  {"disp", {{"B", 6}, {"G", 5}, {"R", 4}}},
                                  {"more", {{"n.X", 7}, {"n.Y", 8}, {"n.Z", 9}, {"R", 0}}}})
            .string();
    EXPECT_EQ(read_first(file), (std::vector<float>{1, 2, 3}));
    ASSERT_EQ(read_texture(file).warnings.size(), 1u);
    EXPECT_HAS(read_texture(file).warnings[0], "parts.exr:disp:,");
    EXPECT_EQ(read_first(file + ":disp"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(file + ":disp:"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(file + ":1:"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(file + ":more:n"), (std::vector<float>{7, 8, 9}));
    EXPECT_EQ(read_first(file + ":n"), (std::vector<float>{7, 8, 9}));
    EXPECT_HAS(message_of([&] { read_texture(file + ":disp:n"); }), "has no layer 'n'");
    EXPECT_HAS(message_of([&] { read_texture(file + ":dips:n"); }), "has no part 'dips'");
}

TEST_F(ExrLayers, are_listed_with_their_parts_types_and_windows) {
    Imf::Header header(Imath::Box2i({0, 0}, {7, 7}), Imath::Box2i({2, 1}, {5, 4}));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    header.channels().insert("d.B", Imf::Channel(Imf::HALF));
    header.channels().insert("d.T", Imf::Channel(Imf::FLOAT));
    header.channels().insert("d.N", Imf::Channel(Imf::HALF));
    {
        Imf::OutputFile output((folder_ / "list.exr").c_str(), header, 0);
        std::vector<char> zeros(1 << 12);
        Imf::FrameBuffer buffer;
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
            buffer.insert(it.name(), Imf::Slice(it.channel().type, zeros.data() + 1024, 4, 32));
        output.setFrameBuffer(buffer);
        output.writePixels(4);
    }
    const std::vector<PicturePart> parts = list_picture_parts(folder_ / "list.exr");
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(std::tie(parts[0].x, parts[0].y, parts[0].width, parts[0].height), std::tuple(2, 1, 4, 4));
    EXPECT_EQ(std::tie(parts[0].full_x, parts[0].full_width, parts[0].full_height), std::tuple(0, 8, 8));
    ASSERT_EQ(parts[0].layers.size(), 2u);
    EXPECT_EQ(parts[0].layers[0].channels, (std::vector<std::string>{"id"}));
    EXPECT_EQ(parts[0].layers[0].types, (std::vector<std::string>{"uint"}));
    EXPECT_EQ(parts[0].layers[1].name, "d");
    EXPECT_EQ(parts[0].layers[1].channels, (std::vector<std::string>{"T", "B", "N"}));
    EXPECT_EQ(parts[0].layers[1].types, (std::vector<std::string>{"float", "half", "half"}));
    EXPECT_TRUE(list_picture_parts(write_pixels<uint8_t>("a.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {1, 2, 3}))
                    .empty());
}

TEST_F(ExrLayers, of_luminance_and_chroma_become_colours) {
    const std::filesystem::path file = folder_ / "chroma.exr";
    {
        Imf::RgbaOutputFile output(file.c_str(), 16, 16, Imf::WRITE_YC);
        const std::vector<Imf::Rgba> pixels(16 * 16, Imf::Rgba(0.75f, 0.5f, 0.25f));
        output.setFrameBuffer(pixels.data(), 1, 16);
        output.writePixels(16);
    }
    const Texture texture = read_texture(file);
    EXPECT_TRUE(texture.warnings.empty()) << texture.warnings[0];
    EXPECT_EQ(texture.channel_count, 3u);
    ASSERT_EQ(texture.source_type, SampleType::float16);
    for (const size_t texel : {size_t(0), size_t(137), size_t(255)}) {
        const auto value = [&](size_t c) {
            half h;
            h.setBits(texture.halves[3 * texel + c]);
            return float(h);
        };
        EXPECT_NEAR(value(0), 0.75f, 0.01f);
        EXPECT_NEAR(value(1), 0.5f, 0.01f);
        EXPECT_NEAR(value(2), 0.25f, 0.01f);
    }
}

TEST_F(ExrLayers, of_scene_files_are_named_by_keys) {
    write("plane.obj", kQuadObj);
    write_exr("layers.exr", {{"beauty.R", 0},
                             {"beauty.G", 0},
                             {"beauty.B", 0},
                             {"vdm.R", 0},
                             {"vdm.G", 0},
                             {"vdm.B", 0.25f},
                             {"sky.R", 1},
                             {"sky.G", 1},
                             {"sky.B", 1}});
    write_parts("parts.exr",
                {{"a", {{"B", 3}, {"G", 2}, {"R", 1}}}, {"b", {{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}}}});
    const auto load = [&](const std::string& keys) {
        return load_scene(write(
            "scene.json",
            R"({"meshes": {"plane": {"file": "plane.obj"}}, "displacements": {"map": {"file": "layers.exr")" +
                keys +
                R"(, "space": "object", "axes": "x,y,z"}}, "materials": {"m": {"base_color_texture": {"file": "parts.exr", "part": "b"}}},
             "environment": {"file": "layers.exr", "layer": "sky"},
             "objects": [{"mesh": "plane", "displacement": "map", "material": "m"}]})"));
    };
    const Scene scene = load(R"(, "layer": "vdm")");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_EQ(first(*scene.displacements[0].tiles[0].texture), (std::vector<float>{0, 0, 0.25f}));
    EXPECT_EQ(first(*scene.environment->texture), (std::vector<float>{1, 1, 1}));
    EXPECT_EQ(test::get_texture(scene.materials[0], MaterialInput::base_color)->floats[0], 0.5f);
    const Scene doubtful = load("");
    ASSERT_EQ(doubtful.warnings.size(), 1u);
    EXPECT_HAS(doubtful.warnings[0], "leaves out");
    EXPECT_HAS(message_of([&] { load(R"(, "layer": "vmd")"); }), "has no layer 'vmd'");
}

TEST_F(ExrLayers, with_colons_in_their_names_are_chosen) {
    const auto make = [](const std::string& layer, float value) {
        return Channels{{layer + ".R", value}, {layer + ".G", value + 1}, {layer + ".B", value + 2}};
    };
    Channels both = make("A", 1);
    for (const auto& channel : make("a:vdm", 4)) both.push_back(channel);
    const std::string one = write_exr("one.exr", both).string();
    EXPECT_EQ(read_first(one + ":a:vdm"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(one + "::a:vdm"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(one + ":a:vdm.G"), (std::vector<float>{5}));
    EXPECT_HAS(read_texture(one).warnings.at(0), "one.exr::a:vdm,");
    EXPECT_HAS(message_of([&] { read_texture(one + ":c:vdm"); }), "has no part 'c'");
    const std::string two =
        write_parts("two.exr", {{"a", make("a:vdm", 1)}, {"a:b", make("vdm", 4)}}).string();
    EXPECT_EQ(read_first(two + "::a:vdm"), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(two + ":a:a:vdm"), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(read_first(two + ":a:b:vdm"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(read_first(two + ":a:b:"), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(split_picture_name(join_picture_name({two, "", "a:vdm"})).layer, "a:vdm");
    write("plane.obj", kQuadObj);
    for (const std::string keys : {R"("layer": "a:vdm")", R"("part": "a", "layer": "a:vdm")"}) {
        const Scene scene = load_scene(write(
            "scene.json", R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"}],
                "environment": {"file": "two.exr", )" +
                              keys + "}}"));
        EXPECT_EQ(first(*scene.environment->texture), (std::vector<float>{1, 2, 3})) << keys;
    }
}

TEST_F(ExrLayers, of_tiles_are_those_of_each_tile) {
    for (const int udim : {1001, 1002})
        write_exr("t." + std::to_string(udim) + ".exr",
                  {{"a.R", 1}, {"a.G", 1}, {"a.B", 1}, {"b.R", float(udim)}, {"b.G", 0}, {"b.B", 0}});
    std::vector<std::string> warnings;
    const Displacement map = load_map(folder_ / "t.<UDIM>.exr:b", {}, warnings);
    ASSERT_EQ(map.tiles.size(), 2u);
    EXPECT_TRUE(map.is_udim);
    EXPECT_EQ(map.tiles[1].texture->floats[0], 1002);
    EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST_F(ExrLayers, with_names_that_are_no_text_are_named_all_the_same) {
    const std::filesystem::path file =
        write_exr("odd.exr", {{"\xff.X", 1}, {"B", 1}, {"G", 1}, {"R", 1}, {"\xc3\xa4.X", 1}});
    const Texture texture = read_texture(file);
    ASSERT_EQ(texture.warnings.size(), 1u);
    EXPECT_HAS(texture.warnings[0], "layer '?' (X)");
    EXPECT_HAS(texture.warnings[0], "layer '\xc3\xa4' (X)");
    EXPECT_EQ(list_picture_parts(file)[0].layers.back().name, "?");
}

TEST_F(ExrLayers, of_files_without_any_are_refused) {
    const std::filesystem::path file =
        write_pixels<uint8_t>("a.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {1, 2, 3});
    EXPECT_EQ(split_picture_name(file.string() + ":x").layer, "") << "a colon belongs to the name";
    EXPECT_EQ(split_picture_name("dir/a.EXR:p:l").file, "dir/a.EXR");
    EXPECT_EQ(split_picture_name("dir/a.EXR:p:l").part, "p");
    EXPECT_EQ(join_picture_name(split_picture_name("dir/a.exr:p:l")), "dir/a.exr:p:l");
    EXPECT_EQ(join_picture_name(split_picture_name("dir/a.exr:l")), "dir/a.exr:l");
}

TEST_F(ExrLayers, that_are_a_cube_are_refused_as_surroundings) {
    Imf::Header header(kSide, kSide);
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    write_exr("cube.exr", {{"B", 1}, {"G", 1}, {"R", 1}}, header);
    const std::filesystem::path scene = write("scene.json", R"({"environment": {"file": "cube.exr"}})");
    EXPECT_HAS(message_of([&] { load_scene(scene); }), "exrenvmap");
    Imf::Header sphere(kSide, kSide);
    Imf::addEnvmap(sphere, Imf::ENVMAP_LATLONG);
    write_exr("cube.exr", {{"B", 1}, {"G", 1}, {"R", 1}}, sphere);
    EXPECT_NO_THROW(load_scene(scene));
}

TEST_F(ExrLayers, with_a_compression_that_is_not_known_are_not_called_damaged) {
    const std::filesystem::path file = write_exr("new.exr", {{"B", 1}, {"G", 1}, {"R", 1}});
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    const std::string entry("compression\0compression\0\1\0\0\0", 28);
    const size_t place = bytes.find(entry);
    ASSERT_NE(place, std::string::npos);
    for (const auto& [value, name] : {std::pair(11, "HTJ2K"), {13, "Zstandard"}, {77, "number 77"}}) {
        bytes[place + entry.size()] = char(value);
        write("new.exr", bytes);
        const std::string message = message_of([&] { read_texture(file); });
        EXPECT_HAS(message, name);
        EXPECT_HAS(message, "ZIP, PIZ or DWAA");
        EXPECT_EQ(message.find("the file is damaged"), std::string::npos) << message;
    }
}

} // namespace relief
