// What is said of a map: presets, encodings, names of tiles, tags of colour in the files.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <OpenImageIO/half.h>

#include "io/png_bytes.h"
#include "io/test_files.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "support/sculpt.h"
#include "surface/patch/surface.h"

namespace relief {

namespace {

constexpr uint32_t kSculptSize = 48;
constexpr uint8_t kLevel = 5;
constexpr float kScale = 2 * test::kSculptReach;
const AxisMap kTnb{{0, 2, 1}, {1, 1, 1}};

/// All texels of the sculpt, along `axes`; `code` turns a displacement into what the file holds.
template <class Value, class Code> std::vector<Value> make_texels(const AxisMap& axes, const Code& code) {
    std::vector<Value> texels;
    for (uint32_t y = 0; y < kSculptSize; ++y)
        for (uint32_t x = 0; x < kSculptSize; ++x)
            for (size_t c = 0; c < 3; ++c)
                texels.push_back(
                    code(test::encode_channel(test::displace_sculpt_texel(kSculptSize, x, y), axes, c)));
    return texels;
}

float keep(float value) { return value; }
uint16_t to_half(float value) { return half(value).bits(); }
template <class Value> Value quantise_sculpt(float value) {
    return Value(std::lround((value / kScale + 0.5f) * float(std::numeric_limits<Value>::max())));
}

std::vector<Vec3f> evaluate(const Displacement& map) {
    const Surface surface = make_surface(test::make_sculpt_plane(), &map, {});
    std::vector<Vec3f> points;
    for (uint32_t j = 0; j <= 1u << kLevel; ++j)
        for (uint32_t i = 0; i <= 1u << kLevel; ++i)
            points.push_back(evaluate_vertex(surface, 0, {kLevel, {kLevel, kLevel, kLevel, kLevel}}, i, j));
    return points;
}

float measure_difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    float largest = 0;
    for (size_t k = 0; k < a.size(); ++k)
        largest = std::max(
            {largest, std::fabs(a[k].x - b[k].x), std::fabs(a[k].y - b[k].y), std::fabs(a[k].z - b[k].z)});
    return largest;
}

} // namespace

class Conventions : public FileTest {
  protected:
    Displacement load(const std::string& file, const MapOptions& options = {}) {
        warnings_.clear();
        return load_map(folder_ / file, options, warnings_);
    }
    std::vector<Vec3f> evaluate_file(const std::string& file, const MapOptions& options) {
        return evaluate(load(file, options));
    }
    /// The five encodings: float and half EXR, float TIFF in another order, 16-bit TIFF, 8-bit PNG.
    void write_encodings() const {
        write_map<float>("f.exr", {}, OIIO::TypeDesc::FLOAT, keep);
        write_map<uint16_t>("h.exr", {}, OIIO::TypeDesc::HALF, to_half);
        write_map<float>("f.tif", kTnb, OIIO::TypeDesc::FLOAT, keep);
        write_map<uint16_t>("w.tif", {}, OIIO::TypeDesc::UINT16, quantise_sculpt<uint16_t>);
        write_map<uint8_t>("b.png", {}, OIIO::TypeDesc::UINT8, quantise_sculpt<uint8_t>);
    }
    template <class Value, class Code>
    void write_map(const std::string& name, const AxisMap& axes, OIIO::TypeDesc type,
                   const Code& code) const {
        write_pixels<Value>(name, kSculptSize, kSculptSize, 3, type, make_texels<Value>(axes, code));
    }
    std::string get_looks(const std::string& file) {
        const Inspection inspection = inspect_map(load(file), MapMeaning::unknown);
        for (const Fact& fact : inspection.facts)
            if (fact.name == "looks_like") return fact.value;
        return {};
    }
    MapOptions say(const std::string& preset) const {
        MapOptions options;
        options.preset = preset;
        return options;
    }

    std::vector<std::string> warnings_;
};

TEST_F(Conventions, five_encodings_give_one_surface) {
    write_encodings();
    const std::vector<Vec3f> reference = evaluate_file("f.exr", say("blender-brush"));
    MapOptions integer = say("genvdm");
    integer.midlevel = Vec3f{0.5f, 0.5f, 0.5f}, integer.scale = Vec3f{kScale, kScale, kScale};
    EXPECT_EQ(measure_difference(reference, evaluate_file("f.tif", say("mudbox"))), 0);
    EXPECT_LT(measure_difference(reference, evaluate_file("h.exr", say("genvdm"))),
              test::kSculptReach / 2048);
    EXPECT_LT(measure_difference(reference, evaluate_file("w.tif", integer)), kScale / 65535);
    EXPECT_LT(measure_difference(reference, evaluate_file("b.png", integer)), kScale / 255);
    // The comparison is able to fail.
    EXPECT_GT(measure_difference(reference, evaluate_file("f.tif", say("genvdm"))), 0.2f);
}

TEST_F(Conventions, each_encoding_looks_like_what_it_is) {
    write_encodings();
    for (const char* file : {"f.exr", "h.exr"})
        EXPECT_HAS(get_looks(file), "tangent space, axes t,b,n, midlevel 0 (presets blender-brush");
    EXPECT_HAS(get_looks("f.tif"), "tangent space, axes t,n,b, midlevel 0 (presets mudbox");
    for (const char* file : {"w.tif", "b.png"})
        EXPECT_HAS(get_looks(file), "tangent space, axes t,b,n, midlevel 0.5 (presets blender-brush");
}

/// Number of commas before a letter.
size_t count_before(const std::string& list, char letter) {
    return size_t(std::count(list.begin(), list.begin() + ptrdiff_t(list.find(letter)), ','));
}

TEST_F(Conventions, any_signed_order_gives_the_same_surface_when_it_is_said) {
    write_encodings();
    const std::vector<Vec3f> reference = evaluate_file("f.exr", say("genvdm"));
    std::mt19937 random(4);
    for (int k = 0; k < 12; ++k) {
        AxisMap axes;
        for (size_t c = 2; c > 0; --c) std::swap(axes.axis[c], axes.axis[random() % (c + 1)]);
        for (int8_t& sign : axes.sign) sign = random() % 2 == 0 ? 1 : -1;
        write_map<float>("turned.exr", axes, OIIO::TypeDesc::FLOAT, keep);
        MapOptions options;
        options.axes = std::string();
        for (size_t c = 0; c < 3; ++c)
            *options.axes +=
                std::string(c > 0 ? "," : "") + (axes.sign[c] < 0 ? "-" : "") + "tbn"[axes.axis[c]];
        EXPECT_EQ(measure_difference(reference, evaluate_file("turned.exr", options)), 0) << *options.axes;
        // The channel along the normal and its sign are clear; of t and b the values may leave quarters of a
        // turn.
        const std::string looks = get_looks("turned.exr"), list = looks.substr(looks.find("axes ") + 5);
        const auto is_negative = [](const std::string& axes) { return axes.find("-n") != std::string::npos; };
        EXPECT_EQ(is_negative(list.substr(0, list.find(' '))), is_negative(*options.axes)) << looks;
        EXPECT_EQ(count_before(list, 'n'), count_before(*options.axes, 'n')) << looks << *options.axes;
        if (looks.find("may be turned by quarters") == std::string::npos)
            EXPECT_HAS(looks, "axes " + *options.axes + ",");
    }
}

TEST_F(Conventions, signed_stands_for_values_from_minus_one_to_one) {
    write_pixels<float>("unit.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {0, 0.5f, 1, 0.5f, 0.5f, 0.5f});
    MapOptions options;
    options.encoding = "signed";
    const Displacement map = load("unit.exr", options);
    EXPECT_EQ(map.midlevel, (Vec3f{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(map.scale, (Vec3f{2, 2, 2}));
    options.midlevel = Vec3f{0.5f, 0, -1}, options.scale = Vec3f{1, 2, 3};
    const Displacement other = load("unit.exr", options); // (2 v - 1 - midlevel) scale
    EXPECT_EQ(other.midlevel, (Vec3f{0.75f, 0.5f, 0}));
    EXPECT_EQ(other.scale, (Vec3f{2, 4, 6}));
    write_pixels<uint16_t>("unit.tif", 1, 1, 3, OIIO::TypeDesc::UINT16, {0, 1, 2});
    options = {};
    options.encoding = "signed";
    EXPECT_EQ(load("unit.tif", options).scale, (Vec3f{2, 2, 2}));
    EXPECT_TRUE(warnings_.empty()) << "with an encoding no midlevel is assumed";
    options.encoding = "unsigned";
    EXPECT_HAS(message_of([&] { load("unit.tif", options); }), "unknown encoding 'unsigned'");
}

TEST_F(Conventions, scene_files_say_the_encoding) {
    write_pixels<float>("unit.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0, 0.5f, 1});
    const auto file =
        write("scene.json", R"({"displacements": {"m": {"file": "unit.exr", "encoding": "signed",
                                              "midlevel": [0.5, 0, 0], "scale": 3}}})");
    const Displacement map = load_scene(file).displacements.at(0);
    EXPECT_EQ(map.midlevel, (Vec3f{0.75f, 0.5f, 0.5f}));
    EXPECT_EQ(map.scale, (Vec3f{6, 6, 6}));
    save_scene(load_scene(file), folder_ / "saved");
    const Displacement again = load_scene(folder_ / "saved" / "scene.json").displacements.at(0);
    EXPECT_EQ(again.midlevel, map.midlevel);
    EXPECT_EQ(again.scale, map.scale);
}

TEST_F(Conventions, presets_say_axes_and_zero) {
    write_pixels<float>("f.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0, 0, 0});
    for (const char* name : {"blender-brush", "genvdm", "3dcoat", "vray-tangent"})
        EXPECT_EQ(load("f.exr", say(name)).axes, AxisMap{}) << name;
    for (const char* name : {"mudbox", "maya", "cycles", "arnold", "moonray", "daz16"})
        EXPECT_EQ(load("f.exr", say(name)).axes, kTnb) << name;
    EXPECT_EQ(load("f.exr", say("mudbox")).midlevel, Vec3f{});
    for (const char* name : {"vray-tangent", "daz16"})
        EXPECT_EQ(load("f.exr", say(name)).midlevel, (Vec3f{0.5f, 0.5f, 0.5f})) << name;
    MapOptions options = say("daz16");
    options.midlevel = Vec3f{}, options.axes = "t,b,n";
    EXPECT_EQ(load("f.exr", options).midlevel, Vec3f{}) << "what is said wins";
    EXPECT_EQ(load("f.exr", options).axes, AxisMap{});
}

TEST_F(Conventions, zbrush_is_refused_with_what_to_do) {
    write_pixels<float>("f.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0, 0, 0});
    for (const char* name : {"zbrush", "zbrush:25"}) {
        const std::string message = message_of([&] { load("f.exr", say(name)); });
        EXPECT_HAS(message, "48 orders");
        EXPECT_HAS(message, "give the axes");
    }
    EXPECT_HAS(message_of([&] { load("f.exr", say("mudbx")); }), "did you mean 'mudbox'?");
}

TEST_F(Conventions, tiles_are_found_by_the_names_of_every_program) {
    const auto write_tile = [&](const std::string& name) {
        write_pixels<float>(name, 1, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3});
    };
    for (const char* name :
         {"zb-VD1001.exr", "zb-VD1012.exr", "m_vdm.1001.exr", "m_vdm.1002.exr", "m_vdm.0999.exr",
          "mud_u1_v1.exr", "mud_u2_v3.exr", "old_u0_v0.exr", "old_u9_v1.exr", "old_u10_v0.exr"})
        write_tile(name);
    const auto get_tiles = [&](const std::string& name) {
        std::vector<int> numbers;
        const Displacement map = load(name);
        for (const MapTile& tile : map.tiles) numbers.push_back(tile.udim);
        EXPECT_TRUE(map.is_udim);
        return numbers;
    };
    EXPECT_EQ(get_tiles("zb-VD<UDIM>.exr"), (std::vector{1001, 1012}));
    EXPECT_EQ(get_tiles("zb-VD<udim>.exr"), (std::vector{1001, 1012}));
    EXPECT_EQ(get_tiles("m_vdm.<UDIM>.exr"), (std::vector{1001, 1002}));
    EXPECT_EQ(get_tiles("mud_<UVTILE>.exr"), (std::vector{1001, 1022}));
    EXPECT_EQ(get_tiles("old_<uvtile>.exr"), (std::vector{1001, 1020}));
    EXPECT_HAS(message_of([&] { load("none_<UVTILE>.exr"); }), "no tile file found");
    EXPECT_HAS(message_of([&] { load("m_vdm.*.exr"); }),
               "tiles named m_vdm.<UDIM>.exr, or frames named m_vdm.####.exr");
    write_tile("two_u1_v1.exr"), write_tile("two_u01_v1.exr");
    EXPECT_HAS(message_of([&] { load("two_<UVTILE>.exr"); }), "two files are tile 1001");
}

TEST_F(Conventions, one_tile_of_several_is_warned_of_with_the_pattern) {
    const auto write_tile = [&](const std::string& name) {
        write_pixels<float>(name, 1, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3});
    };
    for (const char* name : {"a.1001.exr", "a.1002.exr", "b_u1_v1.exr", "b_u2_v1.exr", "c.1001.exr",
                             "d1234.exr", "d1234567.exr"})
        write_tile(name);
    EXPECT_FALSE(load("a.1001.exr").is_udim) << "the name of a file means that file";
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.<UDIM>.exr");
    load("b_u2_v1.exr");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "b_<UVTILE>.exr");
    for (const char* name : {"c.1001.exr", "d1234.exr"}) {
        load(name);
        EXPECT_TRUE(warnings_.empty()) << name;
    }
    EXPECT_EQ(find_tile_pattern(folder_ / "a.1002.exr"), "a.<UDIM>.exr");
    EXPECT_EQ(find_tile_pattern(folder_ / "d1234.exr"), "");
}

TEST_F(Conventions, tags_of_colour_are_read_from_the_file_itself) {
    write_encodings();
    const auto get_tag = [&](const std::string& name) { return read_texture(folder_ / name).colour_tag; };
    for (const char* name : {"f.exr", "h.exr", "f.tif", "w.tif", "b.png"})
        EXPECT_EQ(get_tag(name), "") << name;
    const auto write_tagged = [&](const std::string& name, const std::function<void(OIIO::ImageSpec&)>& tag) {
        auto output = OIIO::ImageOutput::create((folder_ / name).string());
        OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::UINT8);
        tag(spec);
        const std::vector<uint8_t> pixel{1, 2, 3};
        EXPECT_TRUE(output->open((folder_ / name).string(), spec)) << output->geterror();
        EXPECT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixel.data()));
    };
    write_tagged("s.png", [](OIIO::ImageSpec& spec) { spec.attribute("oiio:ColorSpace", "sRGB"); });
    EXPECT_HAS(get_tag("s.png"), " chunk"); // sRGB or gAMA, whichever the writer put first
    write_tagged("c.exr", [](OIIO::ImageSpec& spec) {
        const float values[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), values);
        spec.set_format(OIIO::TypeDesc::HALF);
    });
    EXPECT_EQ(get_tag("c.exr"), "attribute chromaticities");
    write_tagged("x.exr", [](OIIO::ImageSpec& spec) {
        const float values[8] = {1, 0, 0, 1, 0, 0, 0.3333f, 0.3333f};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), values);
        spec.set_format(OIIO::TypeDesc::HALF);
    });
    EXPECT_EQ(get_tag("x.exr"), "attribute chromaticities, which are not those of Rec.709");
    write_tagged("p.tif", [](OIIO::ImageSpec& spec) {
        const std::vector<uint8_t> profile(128, 7);
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, 128), profile.data());
    });
    EXPECT_EQ(get_tag("p.tif"), "ICC profile");
}

TEST_F(Conventions, a_gamma_of_one_is_a_tag_of_linear_values) {
    // The same picture with a chunk put in front of its pixels.
    write_pixels<uint8_t>("p.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {1, 2, 3});
    std::ifstream stream(folder_ / "p.png", std::ios::binary);
    const std::string plain{std::istreambuf_iterator<char>(stream), {}};
    const auto get_tag = [&](const std::string& kind, const std::string& content) {
        std::string text = plain;
        text.insert(8 + 25, test::make_png_chunk(kind, content));
        write("tagged.png", text);
        MapOptions options;
        return load("tagged.png", options).tiles[0].texture->colour_tag;
    };
    EXPECT_EQ(get_tag("gAMA", std::string("\x00\x01\x86\xa0", 4)), kLinearTag);
    EXPECT_EQ(get_tag("gAMA", std::string("\x00\x00\xb1\x8f", 4)), "gAMA chunk");
    EXPECT_EQ(get_tag("tEXt", "a comment"), "");
}

TEST(MapMeaning, is_described_by_options_that_make_it_again) {
    std::vector<MapOptions> cases(5);
    cases[0].preset = "mudbox";
    cases[1].space = "object", cases[1].axes = "x,-z,y", cases[1].midlevel = {0.5f, 0.25f, 0};
    cases[2].frame = "dpdu", cases[2].lengths = "relative", cases[2].scale = {1, 2, 3};
    cases[3].type = "height", cases[3].flip_v = true;
    cases[4].space = "world";
    for (const MapOptions& options : cases) {
        const Displacement map = make_map_meaning(options);
        const MapOptions said = describe_map_meaning(map);
        EXPECT_EQ(said.preset, "");
        EXPECT_EQ(said.frame.has_value(), map.space == DisplacementSpace::tangent);
        const Displacement again = make_map_meaning(said);
        EXPECT_EQ(again.type, map.type);
        EXPECT_EQ(again.space, map.space);
        EXPECT_EQ(again.axes, map.axes);
        EXPECT_EQ(again.frame, map.frame);
        EXPECT_EQ(again.lengths, map.lengths);
        EXPECT_EQ(again.midlevel, map.midlevel);
        EXPECT_EQ(again.scale, map.scale);
        EXPECT_EQ(again.flip_v, map.flip_v);
    }
}

TEST(PictureNames, are_told_by_their_extensions) {
    for (const char* name : {"a.exr", "b/c.PNG", "d.tx", "e.jpeg"})
        EXPECT_TRUE(is_picture_name(name)) << name;
    for (const char* name : {"a.obj", "exr", "scene.json", ""}) EXPECT_FALSE(is_picture_name(name)) << name;
}

} // namespace relief
