#include "surface/patch/level_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "relief/render.h"
#include "surface/test_scenes.h"

namespace relief {

namespace {

Surface make_seamed_surface() {
    const Displacement displacement = test::make_displacement(test::make_noise(256, 256, 0.2f, 2));
    return make_surface(test::make_random_grid(6, 5, 0.4f, 9), &displacement, {});
}

TEST(LevelField, agrees_across_shared_edges_and_patches_are_at_least_as_fine) {
    const Surface surface = make_seamed_surface();
    LevelFieldConfig config;
    config.camera = {-1, -1, 1.5f};
    config.pixel_angle = 0.04f;
    const LevelField field = LevelField::compute(surface, make_scale({1, 2, 1}), config);
    std::map<std::pair<uint32_t, uint32_t>, int> level_of;
    std::array<int, 13> seen{};
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const PatchLevels levels = field.at(patch);
        EXPECT_LE(int(levels.patch), field.max_level());
        for (int k = 0; k < 4; ++k) {
            EXPECT_LE(levels.edge[k], levels.patch);
            const Quad quad = surface.quads[patch];
            const auto key =
                std::minmax({surface.dominant(quad.vertex[k]), surface.dominant(quad.vertex[(k + 1) & 3])});
            EXPECT_EQ(level_of.try_emplace(key, levels.edge[k]).first->second, levels.edge[k]);
            ++seen[levels.edge[k]];
        }
    }
    EXPECT_GE(std::count_if(seen.begin(), seen.end(), [](int count) { return count > 0; }), 3);
}

TEST(LevelField, is_the_same_from_lines_that_were_measured_before) {
    const Surface surface = make_seamed_surface();
    const Affine place = make_scale({1, 2, 1});
    const std::vector<PatchLines> lines = measure_lines(surface, place);
    ASSERT_EQ(lines.size(), surface.patch_count());
    LevelFieldConfig config;
    config.pixel_angle = 0.04f;
    for (const Vec3f& camera : {Vec3f{-1, -1, 1.5f}, Vec3f{2, 3, 0.2f}, Vec3f{0, 0, 900}, Vec3f{1, 1, 0}}) {
        config.camera = camera;
        EXPECT_TRUE(LevelField::choose(surface, lines, config) ==
                    LevelField::compute(surface, place, config));
    }
    EXPECT_FALSE(LevelField::choose(surface, lines, config) == LevelField::compute(surface, {}, config));
    config.fixed_level = 3;
    EXPECT_TRUE(LevelField::choose(surface, lines, config) == LevelField::compute(surface, place, config));
}

TEST(LevelField, is_finite_with_the_camera_inside_and_capped_at_one_cell_a_texel) {
    const Displacement displacement = test::make_displacement(test::make_constant(100, 20, {0, 0, 0}));
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    LevelFieldConfig config;
    config.camera = {0.5f, 0.5f, 0};
    config.pixel_angle = 1e-9f;
    const PatchLevels levels = LevelField::compute(surface, {}, config).at(0);
    EXPECT_EQ(levels, (PatchLevels{7, {7, 5, 7, 5}}));
}

TEST(LevelField, halves_the_cells_at_half_the_distance) {
    const Displacement displacement = test::make_displacement(test::make_constant(4096, 4096, {0, 0, 0}));
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    LevelFieldConfig config;
    config.pixel_angle = 0.01f;
    config.camera = {0.5f, 0.5f, 0.9f + 8};
    const int far = LevelField::compute(surface, {}, config).at(0).patch;
    config.camera = {0.5f, 0.5f, 0.9f + 4};
    EXPECT_EQ(LevelField::compute(surface, {}, config).at(0).patch, far + 1);
    config.camera = {0.5f, 0.5f, 1e6f};
    EXPECT_EQ(LevelField::compute(surface, {}, config).at(0), PatchLevels{});
}

TEST(LevelField, follows_a_bulge_that_the_edges_do_not_show) {
    auto texture = test::make_constant(64, 64, {0, 0, 0});
    for (size_t y = 16; y < 48; ++y)
        for (size_t x = 16; x < 48; ++x) texture->floats[4 * (64 * y + x) + 2] = 30;
    const Displacement displacement = test::make_displacement(texture);
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    LevelFieldConfig config;
    config.camera = {0.5f, 0.5f, 100};
    config.pixel_angle = 0.01f;
    const PatchLevels levels = LevelField::compute(surface, {}, config).at(0);
    EXPECT_GE(levels.patch, levels.edge[0] + 3);
}

TEST(LevelField, fixed_level_is_constant_and_plain_surfaces_have_level_0) {
    LevelFieldConfig config;
    config.fixed_level = 20;
    const LevelField fixed = LevelField::compute(make_seamed_surface(), {}, config);
    EXPECT_EQ(fixed.at(3), (PatchLevels{12, {12, 12, 12, 12}}));
    EXPECT_EQ(fixed.max_level(), kMaxLevel);
    EXPECT_EQ(fixed.byte_count(), 0u);
    const LevelField plain = LevelField::compute(make_surface(test::make_plane(), nullptr, {}), {}, config);
    EXPECT_EQ(plain.at(0), PatchLevels{});
}

} // namespace

} // namespace relief
