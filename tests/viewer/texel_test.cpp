// Texels as numbers, and the curves of the display.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/io.h"
#include "viewer/conventions.h"
#include "viewer/display_table.h"
#include "viewer/fixture.h"
#include "viewer/picture_view.h"

namespace relief::viewer {

TEST(TexelValues, a_step_adds_what_decoding_finds) {
    Displacement map;
    map.axes = {{0, 2, 1}, {1, -1, 1}};
    map.midlevel = {0.5f, 0.25f, 0};
    map.scale = {2, 0.5f, -4};
    const Vec3f value{0.3f, 0.7f, -0.2f}, wanted{0.25f, -1, 2};
    const Vec3f step = encode_step(map, wanted);
    const Vec3f before = decode_texel(map, value);
    const Vec3f after = decode_texel(map, {value.x + step.x, value.y + step.y, value.z + step.z});
    EXPECT_NEAR(after.x - before.x, wanted.x, 1e-5f);
    EXPECT_NEAR(after.y - before.y, wanted.y, 1e-5f);
    EXPECT_NEAR(after.z - before.z, wanted.z, 1e-5f);
    map.scale.y = 0;
    EXPECT_EQ(encode_step(map, wanted).y, 0);
    map.type = DisplacementType::height;
    EXPECT_EQ(encode_step(map, wanted), (Vec3f{1, 0, 0}));
}

TEST(Conventions, presets_say_axes_and_what_zero_is) {
    for (const char* preset : kPresets) {
        Displacement map = make_bumpy_scene().displacements[0];
        EXPECT_NO_THROW(apply_preset(preset, map)) << preset;
    }
    Displacement map = make_bumpy_scene().displacements[0];
    apply_preset("mudbox", map);
    EXPECT_EQ(map.axes, (AxisMap{{0, 2, 1}, {1, 1, 1}}));
    EXPECT_EQ(map.midlevel, (Vec3f{0, 0, 0}));
    apply_preset("vray-tangent", map);
    EXPECT_EQ(map.axes, AxisMap());
    EXPECT_EQ(map.midlevel, (Vec3f{0.5f, 0.5f, 0.5f}));
    EXPECT_ANY_THROW(apply_preset("zbrush", map));
}

TEST(Conventions, axes_stay_a_permutation) {
    AxisMap axes;
    set_axis(axes, 0, 2, -1);
    EXPECT_EQ(axes, (AxisMap{{2, 1, 0}, {-1, 1, 1}}));
    set_axis(axes, 2, 1, 1);
    EXPECT_EQ(axes, (AxisMap{{2, 0, 1}, {-1, 1, 1}}));
    set_axis(axes, 1, 0, -1);
    EXPECT_EQ(axes, (AxisMap{{2, 0, 1}, {-1, -1, 1}}));
}

class DisplayTest : public FolderTest {};

TEST_F(DisplayTest, shows_colours_as_png_files_do) {
    Image image;
    image.width = image.full_width = 64, image.height = image.full_height = 8;
    image.channels = {"R", "G", "B"};
    for (int k = 0; k < 64 * 8; ++k)
        for (const float shift : {0.0f, 1.3f, 2.9f})
            image.pixels.push_back(std::exp2(-8 + 0.025f * float(k)) *
                                   (1 + std::sin(shift + 0.1f * float(k))));
    for (const char* name : kDisplayNames) {
        image.metadata["relief:display"] = name;
        const auto file = folder_ / "shown.png";
        write_image(image, file);
        const Texture expected = read_texture(file);
        const DisplayTable table(name);
        double sum = 0;
        for (uint32_t k = 0; k < 64 * 8; ++k) {
            uint8_t bytes[3];
            table.show({image.pixels[3 * k], image.pixels[3 * k + 1], image.pixels[3 * k + 2]}, bytes);
            const Vec3f value = read_texel(expected, k % 64, k / 64);
            const float wanted[] = {value.x, value.y, value.z};
            for (size_t c = 0; c < 3; ++c) {
                sum += std::fabs(float(bytes[c]) - 255 * wanted[c]);
                ASSERT_NEAR(float(bytes[c]), 255 * wanted[c], 12) << name << " pixel " << k;
            }
        }
        EXPECT_LT(sum / (3 * 64 * 8), 1.0) << name;
    }
}

TEST_F(DisplayTest, what_is_no_number_is_black_and_infinity_is_the_most) {
    const float nothing = std::nanf("");
    for (const DisplayTable& table : {DisplayTable(), DisplayTable("agx"), DisplayTable("standard")}) {
        uint8_t bytes[3], most[3];
        for (const float light : {nothing, -nothing, -INFINITY, -1.0f}) {
            table.show({light, light, light}, bytes);
            EXPECT_LE(bytes[0], 1) << light;
        }
        table.show({INFINITY, INFINITY, INFINITY}, bytes);
        table.show({1e30f, 1e30f, 1e30f}, most);
        EXPECT_EQ(bytes[0], most[0]);
        EXPECT_GT(bytes[0], 250);
    }
    EXPECT_EQ(round_to_byte(nothing), 0);
    EXPECT_EQ(round_to_byte(INFINITY), 255);
}

TEST(PictureView, layers_become_colours_and_nothing_is_black) {
    Image image;
    image.width = image.full_width = 2, image.height = image.full_height = 1;
    image.channels = {"R", "G", "B", "depth.Z", "N.X", "N.Y", "N.Z", "uv.X", "uv.Y", "id.I"};
    image.pixels = {1, 0, 0, 2, 0, 0, 1, 0.5f, 1, 3, 0, 0, 1, INFINITY, 0, 0, 0, 0, 0, 0};
    const auto show = [&](View view) { return make_view(image, {view, 0}, {}); };
    EXPECT_EQ(show(View::color), (std::vector<uint8_t>{255, 0, 0, 255, 0, 0, 255, 255}));
    EXPECT_EQ(show(View::normal), (std::vector<uint8_t>{128, 128, 255, 255, 0, 0, 0, 255}));
    EXPECT_EQ(show(View::depth), (std::vector<uint8_t>{255, 255, 255, 255, 0, 0, 0, 255}));
    EXPECT_EQ(show(View::uv), (std::vector<uint8_t>{128, 255, 0, 255, 0, 0, 0, 255}));
    EXPECT_EQ(show(View::object)[4], 0);
    EXPECT_EQ(show(View::cost), (std::vector<uint8_t>{0, 0, 0, 255, 0, 0, 0, 255})); // no such layer
    EXPECT_NEAR(make_view(image, {View::color, -1}, {})[0], 188, 1); // half of the light, by sRGB
}

} // namespace relief::viewer
