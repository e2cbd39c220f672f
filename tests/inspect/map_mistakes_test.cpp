// Each mistake of a map that inspection tells, and that a good map shows none of them.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "inspect/findings.h"
#include "support/sculpt.h"

namespace relief::test {
namespace {

constexpr uint32_t kMapSize = 64;

Inspection inspect(const Displacement& map) { return inspect_map(map, MapMeaning::unknown); }

/// Stored values from displacements; `type` says what the file claims to hold.
std::shared_ptr<Texture> make_coded(SampleType type, float scale, float midlevel) {
    auto texture = make_sculpt_texture(kMapSize);
    texture->source_type = type;
    for (size_t i = 0; i < texture->floats.size(); ++i)
        if (i % 4 != 3) texture->floats[i] = texture->floats[i] / scale + midlevel;
    return texture;
}

TEST(MapMistakes, a_good_float_map_shows_none) {
    const Inspection inspection = inspect(make_map(make_sculpt_texture(kMapSize)));
    EXPECT_EQ(count_severe(inspection), 0u);
    EXPECT_TRUE(has_code(inspection, "I-FOLD"));
}

TEST(MapMistakes, eight_bits_are_told_with_their_step_in_scene_units) {
    Displacement map = make_map(make_coded(SampleType::uint8, 1.2f, 0.5f));
    map.scale = {2.55f, 2.55f, 2.55f}, map.midlevel = {0.5f, 0.5f, 0.5f};
    const Inspection inspection = inspect_map(map, MapMeaning::declared);
    EXPECT_HAS_PART(find_text(inspection, "W-8BIT"), "0.01 scene units");
    EXPECT_EQ(count_severe(inspection), 1u);
    map.filter = MapFilter::cubic, map.dequantize = true;
    const Inspection smooth = inspect_map(map, MapMeaning::declared);
    EXPECT_EQ(count_severe(smooth), 0u);
    const auto is_filter = [](const Fact& fact) { return fact.name == "filter"; };
    const auto fact = std::find_if(smooth.facts.begin(), smooth.facts.end(), is_filter);
    ASSERT_NE(fact, smooth.facts.end());
    EXPECT_HAS_PART(fact->value, "cubic, dequantised");
    const Texture& texels = *map.tiles[0].texture;
    EXPECT_EQ(fact->numbers.at(0).value, 16.0 * texels.width * texels.height);
}

TEST(MapMistakes, sixteen_bits_without_a_midlevel_are_told_with_their_range) {
    Displacement map = make_map(make_coded(SampleType::uint16, 1.2f, 0.5f));
    EXPECT_HAS_PART(find_text(inspect(map), "W-INT16"), "0.5 is assumed, values are in [0.2");
    map.midlevel = {0.5f, 0.5f, 0.5f};
    EXPECT_EQ(count_severe(inspect_map(map, MapMeaning::declared)), 0u);
}

TEST(MapMistakes, floats_around_a_half_are_an_error_unless_that_was_said) {
    Displacement map = make_map(make_coded(SampleType::float32, 1.2f, 0.5f));
    const Inspection inspection = inspect(map);
    EXPECT_HAS_PART(find_text(inspection, "E-NONEG"), "encoding signed");
    EXPECT_EQ(count_severe(inspection), 1u) << "the same offset is told once";
    EXPECT_HAS_PART(get_fact(inspection, "looks_like"), "midlevel 0.5");
    map.midlevel = {0.5f, 0.5f, 0.5f};
    EXPECT_EQ(count_severe(inspect_map(map, MapMeaning::declared)), 0u);
}

TEST(MapMistakes, a_midlevel_of_zero_that_was_said_is_taken_at_its_word) {
    Displacement map = make_map(make_coded(SampleType::float32, 1.2f, 0.5f));
    EXPECT_TRUE(has_code(inspect_map(map, MapMeaning::declared), "E-NONEG")) << "other things were said";
    map.has_midlevel = true;
    const Inspection inspection = inspect_map(map, MapMeaning::declared);
    EXPECT_EQ(count_severe(inspection), 0u);
    EXPECT_HAS_PART(find_text(inspection, "I-NONEG"), "midlevel 0.5");
    EXPECT_HAS_PART(get_fact(inspection, "midlevel"), "0, as declared");
    map = make_map(make_coded(SampleType::uint16, 1.2f, 0.5f));
    EXPECT_TRUE(has_code(inspect_map(map, MapMeaning::declared), "W-INT16"));
    map.has_midlevel = true;
    EXPECT_FALSE(has_code(inspect_map(map, MapMeaning::declared), "W-INT16"));
    EXPECT_FALSE(
        has_code(inspect_map(make_map(make_sculpt_texture(kMapSize)), MapMeaning::declared), "I-NONEG"));
}

TEST(MapMistakes, a_colour_tag_of_the_file_is_told) {
    auto texture = make_sculpt_texture(kMapSize);
    texture->colour_tag = "sRGB chunk";
    EXPECT_HAS_PART(find_text(inspect(make_map(texture)), "W-SRGB"), "sRGB chunk");
}

TEST(MapMistakes, a_map_of_one_value_is_empty) {
    auto texture = make_sculpt_texture(kMapSize);
    std::fill(texture->floats.begin(), texture->floats.end(), 0.25f);
    Displacement map = make_map(texture);
    EXPECT_HAS_PART(find_text(inspect(map), "W-EMPTY"), "0.25");
    EXPECT_FALSE(has_code(inspect(map), "W-GRAY"));
    map.type = DisplacementType::height;
    EXPECT_TRUE(has_code(inspect_map(map, MapMeaning::declared), "W-EMPTY"));
    texture->floats[0] = 0;
    EXPECT_FALSE(has_code(inspect(map), "W-EMPTY"));
}

TEST(MapMistakes, one_channel_and_equal_channels_are_heights) {
    auto texture = make_sculpt_texture(kMapSize);
    for (size_t i = 0; i < texture->floats.size(); i += 4)
        texture->floats[i] = texture->floats[i + 1] = texture->floats[i + 2];
    Displacement map = make_map(texture);
    EXPECT_TRUE(has_code(inspect(map), "W-GRAY"));
    map.type = DisplacementType::height;
    EXPECT_EQ(count_severe(inspect_map(map, MapMeaning::declared)), 0u);
    texture->channel_count = 1;
    EXPECT_TRUE(has_code(inspect(map), "W-1CH"));
    EXPECT_EQ(count_severe(inspect_map(map, MapMeaning::declared)), 0u);
}

TEST(MapMistakes, a_normal_map_is_recognised) {
    auto texture = make_sculpt_texture(kMapSize);
    texture->source_type = SampleType::uint8;
    for (uint32_t k = 0; k < kMapSize * kMapSize; ++k) {
        const float x = 0.4f * std::sin(0.3f * float(k)), y = 0.4f * std::cos(0.7f * float(k));
        const float z = std::sqrt(1 - x * x - y * y);
        const float texel[3] = {x, y, z};
        for (size_t c = 0; c < 3; ++c) texture->floats[4 * k + c] = 0.5f + 0.5f * texel[c];
    }
    EXPECT_TRUE(has_code(inspect(make_map(texture)), "W-NORMALMAP"));
}

TEST(MapMistakes, a_bad_texel_is_an_error_with_its_place_and_tile) {
    auto good = make_sculpt_texture(kMapSize), bad = make_sculpt_texture(kMapSize);
    bad->floats[4 * (3 * kMapSize + 5) + 1] = std::numeric_limits<float>::quiet_NaN();
    const Inspection single = inspect(make_map(bad));
    EXPECT_HAS_PART(find_text(single, "E-NAN"), "1 texel(s), the first at column 5, row 3;");
    Displacement map = make_map(good);
    map.is_udim = true;
    map.tiles.push_back({1012, bad});
    EXPECT_HAS_PART(find_text(inspect(map), "E-NAN"), "column 5, row 3, tile 1012");
}

TEST(MapMistakes, a_map_of_nothing_but_bad_texels_is_told) {
    auto texture = make_sculpt_texture(4);
    for (float& value : texture->floats) value = std::numeric_limits<float>::infinity();
    EXPECT_HAS_PART(find_text(inspect(make_map(texture)), "E-NAN"), "16 texel(s)");
}

TEST(MapMistakes, a_texel_far_out_is_told_with_its_place) {
    auto texture = make_sculpt_texture(kMapSize);
    texture->floats[4 * (7 * kMapSize + 9) + 2] = 40;
    const std::string text = find_text(inspect(make_map(texture)), "W-OUTLIER");
    EXPECT_HAS_PART(text, "column 9, row 7 is 40 long");
}

TEST(MapMistakes, a_constant_offset_is_told_with_its_values) {
    auto texture = make_sculpt_texture(kMapSize);
    for (size_t i = 0; i < texture->floats.size(); i += 4) texture->floats[i] += 0.25f;
    const std::string text = find_text(inspect(make_map(texture)), "W-BORDER");
    EXPECT_HAS_PART(text, "(0.25, 0, 0)");
    EXPECT_HAS_PART(text, "most in R");
    auto constant = make_sculpt_texture(kMapSize);
    for (size_t i = 0; i < constant->floats.size(); ++i) constant->floats[i] = i % 4 == 1 ? 0.1f : 0.0f;
    EXPECT_TRUE(has_code(inspect(make_map(constant)), "W-BORDER"));
}

TEST(MapMistakes, a_length_far_from_the_size_of_the_mesh_is_told) {
    const Mesh plane = make_sculpt_plane();
    Displacement map = make_map(make_sculpt_texture(kMapSize));
    EXPECT_EQ(count_severe(inspect_map(map, MapMeaning::declared, &plane)), 0u);
    map.scale = {100, 100, 100};
    EXPECT_TRUE(has_code(inspect_map(map, MapMeaning::declared, &plane), "W-SCALE"));
    map.scale = {1e-6f, 1e-6f, 1e-6f};
    EXPECT_TRUE(has_code(inspect_map(map, MapMeaning::declared, &plane), "W-SCALE"));
}

TEST(MapMistakes, a_mesh_finer_than_its_map_is_told) {
    Mesh mesh = make_sculpt_plane();
    const Displacement map = make_map(make_sculpt_texture(kMapSize));
    mesh.uvs = {{0, 0}, {0.01f, 0}, {0.01f, 0.01f}, {0, 0.01f}};
    EXPECT_HAS_PART(find_text(inspect_map(map, MapMeaning::unknown, &mesh), "W-LEVEL"), "finer than its map");
    mesh.uvs = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
    EXPECT_HAS_PART(find_text(inspect_map(map, MapMeaning::unknown, &mesh), "W-LEVEL"), "finest level");
}

TEST(MapMistakes, folds_are_a_note_with_their_share) {
    const Mesh plane = make_sculpt_plane();
    Displacement map = make_map(make_sculpt_texture(kMapSize));
    const std::string steep = find_text(inspect_map(map, MapMeaning::declared, &plane), "I-FOLD");
    EXPECT_HAS_PART(steep, "folds over in 1"); // 13 to 15 of 100 texels
    map.scale = {0.2f, 0.2f, 1};
    EXPECT_FALSE(has_code(inspect_map(map, MapMeaning::declared, &plane), "I-FOLD"));
}

} // namespace
} // namespace relief::test
