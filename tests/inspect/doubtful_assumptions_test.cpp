// Warnings of maps whose convention nobody stated.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "inspect/findings.h"
#include "support/bodies.h"
#include "support/sculpt.h"

namespace relief::test {
namespace {

constexpr AssumedConvention kAll{.space = true, .axes = true, .midlevel = true, .wrap = true};

Inspection find(const std::shared_ptr<const Texture>& texture, const AssumedConvention& assumed,
                Mesh plane = make_sculpt_plane()) {
    Displacement map = make_map(texture);
    map.assumed = assumed;
    return {{}, find_doubtful_assumptions(make_body_scene(std::move(plane), std::move(map)))};
}

constexpr AxisMap kMudbox{{0, 2, 1}, {1, 1, 1}};

TEST(DoubtfulAssumptions, name_the_axes_that_the_values_speak_for) {
    const auto texture = make_sculpt_texture(64, kMudbox);
    const Inspection doubts = find(texture, kAll);
    ASSERT_EQ(doubts.findings.size(), 1u);
    EXPECT_EQ(doubts.findings[0].severity, Severity::warning);
    EXPECT_HAS_PART(find_text(doubts, "I-AXES"), "displacement 'map': axes t,b,n are assumed");
    EXPECT_HAS_PART(find_text(doubts, "I-AXES"), "presets mudbox, maya, cycles, arnold, moonray write t,n,b");
    EXPECT_TRUE(find(make_sculpt_texture(64), kAll).findings.empty());
}

TEST(DoubtfulAssumptions, doubt_declared_axes_where_the_values_are_clear) {
    const Inspection wrong = find(make_sculpt_texture(64, kMudbox), {});
    ASSERT_EQ(wrong.findings.size(), 1u);
    EXPECT_EQ(wrong.findings[0].severity, Severity::note) << "who declared them may know better";
    EXPECT_HAS_PART(find_text(wrong, "I-AXES"), "axes t,b,n are declared");
    EXPECT_HAS_PART(find_text(wrong, "I-AXES"), "moonray write t,n,b");
    EXPECT_TRUE(find(make_sculpt_texture(64), {}).findings.empty());
    constexpr AxisMap kExchanged{{1, 0, 2}, {1, 1, 1}};
    EXPECT_TRUE(find(make_sculpt_texture(64, kExchanged), {}).findings.empty()) << "t and b are less clear";
}

TEST(DoubtfulAssumptions, measure_channels_by_their_scale) {
    Displacement map = make_map(make_sculpt_texture(64, kMudbox));
    map.scale = {1, 0.01f, 20};
    EXPECT_TRUE(find_doubtful_assumptions(make_body_scene(make_sculpt_plane(), std::move(map))).empty());
}

TEST(DoubtfulAssumptions, say_nothing_of_axes_that_somebody_knows_where_the_values_are_less_clear) {
    auto texture = make_sculpt_texture(64, kMudbox);
    // The first channel is to one side as well, though less so, and the one along the normal is 1.7 times as
    // strong.
    for (size_t k = 0; k < texture->floats.size(); k += 4)
        texture->floats[k] = texture->floats[k + 1] / 1.7f * (k / 4 % 4 == 0 ? -1.0f : 5.0f / 3);
    EXPECT_FALSE(has_code(find(texture, {}), "I-AXES"));
    EXPECT_TRUE(has_code(find(texture, {.axes = true}), "I-AXES"));
}

TEST(DoubtfulAssumptions, say_nothing_of_what_was_stated) {
    auto half = std::make_shared<Texture>(*make_sculpt_texture(64));
    for (float& value : half->floats) value = 0.5f + 0.5f * value;
    EXPECT_TRUE(has_code(find(half, kAll), "E-NONEG"));
    EXPECT_TRUE(has_code(find(half, {.midlevel = true}), "E-NONEG"));
    EXPECT_FALSE(has_code(find(half, {.space = true, .axes = true, .wrap = true}), "E-NONEG"));
}

TEST(DoubtfulAssumptions, tell_mirrored_uvs_and_triangles_of_the_mesh) {
    const auto texture = make_sculpt_texture(64);
    Mesh mirrored = make_sculpt_plane();
    for (Vec2f& uv : mirrored.uvs) uv.x = 1 - uv.x;
    const std::string text = find_text(find(texture, kAll, mirrored), "W-MIRROR");
    EXPECT_HAS_PART(text, "of mesh 'plane' are mirrored");
    EXPECT_HAS_PART(text, "displacement.space = tangent");
    EXPECT_FALSE(has_code(find(texture, {.axes = true}, mirrored), "W-MIRROR")) << "tangent space was said";
    EXPECT_FALSE(has_code(find(texture, kAll), "W-MIRROR"));
    Mesh triangle = make_sculpt_plane();
    triangle.face_sizes = {3};
    triangle.position_indices.resize(3), triangle.uv_indices.resize(3);
    EXPECT_HAS_PART(find_text(find(texture, kAll, triangle), "W-TRI"), "1 of 1 faces");
    EXPECT_FALSE(has_code(find(texture, AssumedConvention{}, triangle), "W-TRI")) << "all was said";
    EXPECT_FALSE(has_code(find(texture, kAll), "W-TRI"));
}

TEST(DoubtfulAssumptions, tell_uvs_that_faces_share) {
    const auto texture = make_sculpt_texture(64);
    Mesh twice = make_sculpt_plane();
    const size_t corners = twice.position_indices.size(), faces = twice.face_sizes.size();
    for (size_t k = 0; k < corners; ++k) {
        twice.position_indices.push_back(twice.position_indices[k]);
        twice.uv_indices.push_back(twice.uv_indices[k]);
    }
    for (size_t k = 0; k < faces; ++k) twice.face_sizes.push_back(twice.face_sizes[k]);
    const std::string text = find_text(find(texture, kAll, twice), "W-UVOVER");
    EXPECT_HAS_PART(text, "share 100.0 % of the uv area");
    EXPECT_HAS_PART(text, "displacement.wrap = clamp");
    EXPECT_FALSE(has_code(find(texture, {.space = true, .axes = true}, twice), "W-UVOVER"))
        << "wrap was said";
    EXPECT_FALSE(has_code(find(texture, kAll), "W-UVOVER"));
    twice.uv_indices[corners] = kNoIndex; // its face is not displaced
    EXPECT_FALSE(has_code(find(texture, kAll, twice), "W-UVOVER") && faces == 1);
}

/// A tube that is open on one side, without seams, and what moves it outwards in object space.
Mesh make_open_tube(Texture& outwards) {
    constexpr uint32_t kColumns = 24;
    constexpr float kArc = 6.0f;
    Mesh tube;
    tube.name = "tube";
    for (uint32_t k = 0; k <= kColumns; ++k)
        for (const float y : {-1.0f, 1.0f}) {
            const float u = float(k) / kColumns;
            tube.positions.push_back({std::sin(kArc * u), y, std::cos(kArc * u)});
            tube.uvs.push_back({u, y / 2 + 0.5f});
        }
    for (uint32_t k = 0; k < kColumns; ++k) {
        tube.face_sizes.push_back(4);
        for (const uint32_t corner : {2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1})
            tube.position_indices.push_back(corner), tube.uv_indices.push_back(corner);
    }
    outwards.width = 64, outwards.height = 4, outwards.channel_count = 3;
    for (uint32_t k = 0; k < 64 * 4; ++k) {
        const float angle = kArc * (float(k % 64) + 0.5f) / 64;
        outwards.floats.insert(outwards.floats.end(), {0.1f * std::sin(angle), 0, 0.1f * std::cos(angle), 1});
    }
    return tube;
}

TEST(DoubtfulAssumptions, tell_object_space_where_no_seam_does) {
    auto outwards = std::make_shared<Texture>();
    const Mesh tube = make_open_tube(*outwards);
    const Inspection doubts = find(outwards, kAll, tube);
    EXPECT_HAS_PART(find_text(doubts, "I-SPACE"), "displacement.space = object");
    EXPECT_FALSE(has_code(find(outwards, {.axes = true, .midlevel = true}, tube), "I-SPACE"));
}

TEST(DoubtfulAssumptions, tell_uvs_outside_of_one_image) {
    Mesh plane = make_sculpt_plane();
    plane.uvs[1].x = plane.uvs[2].x = 1.5f;
    const auto texture = make_sculpt_texture(64);
    EXPECT_HAS_PART(find_text(find(texture, kAll, plane), "W-UVRANGE"), "displacement.wrap = repeat");
    EXPECT_FALSE(
        has_code(find(texture, {.space = true, .axes = true, .midlevel = true}, plane), "W-UVRANGE"));
    plane.uvs[1].x = plane.uvs[2].x = 1.0001f; // rounding of a writer
    EXPECT_FALSE(has_code(find(texture, kAll, plane), "W-UVRANGE"));
}

TEST(DoubtfulAssumptions, of_a_large_map_are_those_of_a_part_of_its_texels) {
    // 1024 x 1024: every second texel of every second row is looked at.
    const auto small = make_sculpt_texture(512, kMudbox);
    auto large = std::make_shared<Texture>();
    large->width = large->height = 1024, large->channel_count = 3;
    large->floats.assign(size_t(4) * 1024 * 1024, std::numeric_limits<float>::quiet_NaN());
    for (uint32_t y = 0; y < 512; ++y)
        for (uint32_t x = 0; x < 512; ++x)
            std::copy_n(&small->floats[4 * (size_t(y) * 512 + x)], 4,
                        &large->floats[4 * ((size_t(2) * y + 1) * 1024 + 2 * x + 1)]);
    const Inspection doubts = find(large, kAll);
    EXPECT_HAS_PART(find_text(doubts, "I-AXES"), "write t,n,b");
    EXPECT_FALSE(has_code(doubts, "E-NAN")) << "a texel between them was read";
}

TEST(DoubtfulAssumptions, note_tiles_under_no_face) {
    Displacement map = make_map(make_sculpt_texture(64));
    map.is_udim = true;
    const Scene one = make_body_scene(make_sculpt_plane(), map);
    EXPECT_TRUE(find_doubtful_assumptions(one).empty());
    map.tiles.push_back({1003, map.tiles[0].texture}), map.tiles.push_back({1002, map.tiles[0].texture});
    const Inspection doubts{{}, find_doubtful_assumptions(make_body_scene(make_sculpt_plane(), map))};
    ASSERT_EQ(doubts.findings.size(), 1u);
    EXPECT_EQ(doubts.findings[0].severity, Severity::note);
    EXPECT_HAS_PART(find_text(doubts, "I-TILES"), "uses 2 of its 3 tiles (1002, 1003)");
}

} // namespace
} // namespace relief::test
