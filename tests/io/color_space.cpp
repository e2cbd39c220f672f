// Textures and pictures in colour spaces other than linear Rec.709.
#include "io/picture/color_space.h"

#include <cmath>
#include <cstdlib>

#include "io/scene/scene_reader.h"
#include "io/test_files.h"
#include "relief/io.h"
#include "support/input_textures.h"

namespace relief {

class ColorSpaces : public FileTest {
  protected:
    /// First texel of a float picture in a space, as the base colour of a material.
    Vec3f load(const std::string& file, const std::string& space) const {
        const std::string text = R"({"materials": {"a": {"base_color_texture": {"file": ")" + file +
                                 R"(", "color_space": ")" + space + R"("}}}})";
        const Scene scene = parse_scene(text, folder_, "s.json");
        const std::vector<float>& floats =
            test::get_texture(scene.materials.at(0), MaterialInput::base_color)->floats;
        return {floats.at(0), floats.at(1), floats.at(2)};
    }
    void write_color(const std::vector<float>& rgb) const {
        write_pixels<float>("c.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, rgb);
    }
};

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST_F(ColorSpaces, textures_become_linear_rec709) {
    write_color({1, 0, 0});
    expect_near(load("c.exr", "linear"), {1, 0, 0}, 0);
    // AP1 to Rec.709 with Bradford's adaptation (Academy 2016, TB-2014-004 and ACES 1.0.3).
    expect_near(load("c.exr", "acescg"), {1.70505f, -0.13026f, -0.02400f}, 1e-4f);
    write_color({0.5f, 0.5f, 0.5f});
    expect_near(load("c.exr", "acescg"), {0.5f, 0.5f, 0.5f}, 1e-4f);
    expect_near(load("c.exr", "aces2065-1"), {0.5f, 0.5f, 0.5f}, 1e-4f);
    expect_near(load("c.exr", "srgb"), {0.2140411f, 0.2140411f, 0.2140411f}, 1e-6f);
    // Middle grey in ACEScct (Academy 2016, S-2016-001): (log2(0.18) + 9.72) / 17.52.
    write_color({0.4135884f, 0.4135884f, 0.4135884f});
    expect_near(load("c.exr", "acescct"), {0.18f, 0.18f, 0.18f}, 1e-3f);
}

TEST_F(ColorSpaces, an_explicit_space_holds_for_integers_and_halves_too) {
    write_pixels<uint8_t>("c.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {51, 51, 51});
    expect_near(load("c.png", "linear"), {0.2f, 0.2f, 0.2f}, 1e-6f);
    expect_near(load("c.png", "auto"), {0.0331048f, 0.0331048f, 0.0331048f}, 1e-6f);
    write_pixels<uint16_t>("h.exr", 1, 1, 3, OIIO::TypeDesc::HALF, {0x3800, 0x3800, 0x3800}); // 0.5
    expect_near(load("h.exr", "srgb"), {0.2140411f, 0.2140411f, 0.2140411f}, 1e-4f);
}

TEST_F(ColorSpaces, environments_have_one_as_well) {
    write_pixels<float>("e.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {1, 0, 0, 1, 1, 1});
    const Scene scene =
        parse_scene(R"({"environment": {"file": "e.exr", "color_space": "acescg"}})", folder_, "s.json");
    const std::vector<float>& floats = scene.environment->texture->floats;
    EXPECT_NEAR(floats.at(0), 1.70505f, 1e-4f);
    EXPECT_EQ(floats.at(1), 0) << "radiance is not negative";
    EXPECT_HAS(message_of([&] {
                   parse_scene(R"({"environment": {"color": [1, 1, 1], "color_space": "acescg"}})", folder_,
                               "s.json");
               }),
               "is that of a file");
}

TEST_F(ColorSpaces, spaces_of_a_configuration_are_known) {
    write("config.ocio", R"(ocio_profile_version: 2
roles: {aces_interchange: aces, default: aces}
file_rules: [!<Rule> {name: Default, colorspace: aces}]
displays: {d: [!<View> {name: v, colorspace: aces}]}
colorspaces:
  - !<ColorSpace> {name: aces}
  - !<ColorSpace> {name: dark, to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}}
)");
    write_color({0.25f, 0.25f, 0.25f});
    EXPECT_HAS(message_of([&] { load("c.exr", "dark"); }), "no colour space of that name: 'dark'");
    setenv("OCIO", (folder_ / "config.ocio").c_str(), 1);
    expect_near(load("c.exr", "dark"), {0.5f, 0.5f, 0.5f}, 1e-4f);
    expect_near(load("c.exr", "acescg"), {0.25f, 0.25f, 0.25f}, 1e-4f);
    setenv("OCIO", (folder_ / "none.ocio").c_str(), 1);
    const std::string message = message_of([&] { load("c.exr", "dark"); });
    unsetenv("OCIO");
    EXPECT_HAS(message, "none.ocio");
    EXPECT_HAS(message_of([&] { load("c.exr", "acesgc"); }), "did you mean 'acescg'?");
}

Image make_layers() {
    Image image;
    image.width = image.full_width = 2, image.height = image.full_height = 1;
    image.channels = {"R",
                      "G",
                      "B",
                      "A",
                      "albedo.R",
                      "albedo.G",
                      "albedo.B",
                      "variance.R",
                      "variance.G",
                      "variance.B",
                      "CryptoObject00.R",
                      "CryptoObject00.G",
                      "CryptoObject00.B",
                      "N.X"};
    for (int k = 0; k < 2 * 14; ++k) image.pixels.push_back(0.25f + 0.125f * float(k % 5));
    return image;
}

TEST_F(ColorSpaces, pictures_are_written_in_one_and_read_back_in_linear_rec709) {
    for (const char* space : {"acescg", "aces2065-1"}) {
        Image image = make_layers();
        image.metadata[kColorSpaceTag] = space;
        write_image(image, folder_ / "p.exr");
        const Texture stored = read_texture(folder_ / "p.exr");
        EXPECT_GT(std::fabs(stored.floats.at(0) - image.pixels[0]), 0.005f) << "not converted: " << space;
        const Image read = read_image(folder_ / "p.exr");
        EXPECT_EQ(read.metadata.at(kColorSpaceTag), space);
        ASSERT_EQ(read.channels.size(), image.channels.size());
        for (size_t c = 0; c < image.channels.size(); ++c) {
            const size_t there = read.find_channel(image.channels[c]).value();
            const bool is_color = c < 3 || (c > 3 && c < 7);
            EXPECT_NEAR(read.pixels[there], image.pixels[c], is_color ? 1e-5f : 0) << image.channels[c];
        }
        const auto input = OIIO::ImageInput::open((folder_ / "p.exr").string());
        float xy[8] = {};
        ASSERT_TRUE(
            input->spec().getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy));
        EXPECT_NEAR(xy[0], space == std::string("acescg") ? 0.713f : 0.7347f, 1e-6f);
        EXPECT_NEAR(xy[6], 0.32168f, 1e-6f);
    }
}

TEST_F(ColorSpaces, files_with_other_primaries_are_warned_of_where_no_space_is_named) {
    Image image = make_layers();
    image.channels.resize(3), image.pixels.resize(6);
    image.metadata[kColorSpaceTag] = "acescg";
    write_image(image, folder_ / "p.exr");
    const auto list_warnings = [&](const std::string& space) {
        return parse_scene(R"({"environment": {"file": "p.exr")" + space + "}}", folder_, "s.json").warnings;
    };
    const std::vector<std::string> warnings = list_warnings("");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "names primaries of another colour space");
    EXPECT_TRUE(list_warnings(R"(, "color_space": "acescg")").empty());
    EXPECT_TRUE(list_warnings(R"(, "color_space": "linear")").empty());
}

TEST_F(ColorSpaces, a_file_in_an_unknown_one_is_refused) {
    Image image = make_layers();
    image.metadata[kColorSpaceTag] = "acecg";
    EXPECT_HAS(message_of([&] { write_image(image, folder_ / "p.exr"); }), "did you mean 'acescg'?");
}

} // namespace relief
