#include <gtest/gtest.h>

#include "formulas/mips.h"
#include "surface/map/mip_chain.h"
#include "surface/map/texels.h"
#include "surface/test_scenes.h"

namespace relief {

namespace {

std::shared_ptr<Texture> make_map(uint32_t kind, uint32_t seed) {
    switch (kind) {
    case 0:
        return test::make_noise(64, 48, 0.5f, seed);
    case 1:
        return test::make_noise(1, 1, 0.5f, seed);
    case 2:
        return test::make_noise(33, 17, 1e15f, seed);
    case 3:
        return test::make_noise(16, 16, 1e-30f, seed);
    case 4:
        return test::make_constant(20, 20, {0.1f, 0.7f, -0.3f});
    case 5: {
        auto texture = test::make_noise(40, 40, 1, seed);
        for (const float value : texture->floats)
            texture->halves.push_back(
                uint16_t((value < 0 ? 0x8000u : 0u) | uint32_t(std::fabs(value) * 0x3c00)));
        texture->floats.clear();
        return texture;
    }
    default:
        return test::make_noise(7, 130, 100, seed);
    }
}

Displacement make_random_displacement(uint32_t round, std::mt19937& random) {
    Displacement displacement = test::make_displacement(make_map(round % 7, round));
    displacement.space = random() % 2 == 0 ? DisplacementSpace::object : DisplacementSpace::tangent;
    displacement.type = random() % 4 == 0 ? DisplacementType::height : DisplacementType::vector;
    displacement.wrap = WrapMode(random() % 4);
    displacement.flip_v = random() % 2 == 0;
    const float scales[4] = {1, -3, 1e-4f, 50};
    displacement.scale = {scales[random() % 4], scales[random() % 4], scales[random() % 4]};
    if (random() % 2 == 0) displacement.midlevel = {0.5f, 0.1f, -0.3f};
    displacement.axes.axis = {1, 2, 0};
    displacement.axes.sign = {1, -1, 1};
    displacement.frame = random() % 2 == 0 ? FrameKind::mikk : FrameKind::dpdu;
    if (round % 7 != 2) displacement.lengths = FrameLengths(random() % 2);
    return displacement;
}

/// Any copies of the map, also such as no view would ask for.
void filter_at_random(Surface& surface, std::mt19937& random) {
    DisplacementMap::Tile& tile = surface.map.tiles[0];
    tile.mips = std::make_shared<MipChain>(*tile.texture, OutsideTexels{}, surface.map.wrap);
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        surface.mips.push_back(uint32_t(random()) & ((1u << scalar::kDetailShift) - 1));
}

PatchLevels make_random_levels(std::mt19937& random) {
    PatchLevels levels;
    levels.patch = uint8_t(random() % 6);
    for (uint8_t& edge : levels.edge) edge = uint8_t(random() % (levels.patch + 1u));
    return levels;
}

void expect_tile_boxes_hold(const Surface& surface, uint32_t patch, const PatchLevels& levels,
                            std::mt19937& random) {
    const uint32_t n = 1u << levels.patch;
    const auto choose = [&] {
        return std::array<uint32_t, 2>{uint32_t(random() % n), uint32_t(random() % n)};
    };
    const auto a = choose(), b = choose();
    const std::array<uint32_t, 4> cells = {std::min(a[0], b[0]), std::min(a[1], b[1]),
                                           std::max(a[0], b[0]) + 1, std::max(a[1], b[1]) + 1};
    const Box box = compute_tile_box(surface, patch, levels, cells);
    for (uint32_t j = cells[1]; j <= cells[3]; ++j)
        for (uint32_t i = cells[0]; i <= cells[2]; ++i)
            ASSERT_TRUE(box.contains(evaluate_vertex(surface, patch, levels, i, j)));
}

TEST(Bounds, hold_every_corner_of_every_cell) {
    std::mt19937 random(11);
    for (uint32_t round = 0; round < 140; ++round) {
        const Displacement displacement = make_random_displacement(round, random);
        Mesh mesh = test::make_random_grid(2, 2, 0.5f, round);
        if (round % 5 == 0)
            for (Vec2f& uv : mesh.uvs) uv = {uv.x * 37 - 11, uv.y * 5 + 100};
        if (round % 6 == 0)
            for (Vec3f& p : mesh.positions) p = p * 1e-3f + Vec3f{1000, -500, 0.1f};
        Surface surface = make_surface(mesh, &displacement, {});
        if (round % 4 == 1) filter_at_random(surface, random);
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Box box = compute_patch_box(surface, patch);
            for (int k = 0; k < 3; ++k) {
                const PatchLevels levels = make_random_levels(random);
                const uint32_t n = 1u << levels.patch;
                for (uint32_t j = 0; j <= n; ++j)
                    for (uint32_t i = 0; i <= n; ++i)
                        ASSERT_TRUE(box.contains(evaluate_vertex(surface, patch, levels, i, j)))
                            << "round " << round;
                for (int tile = 0; tile < 4; ++tile) expect_tile_boxes_hold(surface, patch, levels, random);
                if (HasFatalFailure()) FAIL() << "round " << round;
            }
        }
    }
}

TEST(Bounds, of_a_constant_map_are_tight) {
    const Displacement displacement = test::make_displacement(test::make_constant(64, 64, {0.25f, 0, 2}));
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    const Box box = compute_patch_box(surface, 0);
    EXPECT_NEAR(box.lower.x, 0.25f, 1e-5f);
    EXPECT_NEAR(box.upper.x, 1.25f, 1e-5f);
    EXPECT_NEAR(box.lower.z, 2, 1e-5f);
    EXPECT_NEAR(box.upper.z, 2, 1e-5f);
}

TEST(Bounds, follow_the_part_of_the_map_that_a_patch_covers) {
    auto texture = test::make_constant(256, 256, {0, 0, 0});
    texture->floats[4 * (256 * 200 + 200) + 2] = 50;
    const Displacement displacement = test::make_displacement(texture);
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv = {uv.x * 0.5f, uv.y * 0.5f + 0.5f};
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_LT(compute_patch_box(surface, 0).upper.z, 1e-3f);
}

TEST(BoundsPyramid, query_holds_every_wrapped_texel) {
    std::mt19937 random(5);
    const std::array<uint32_t, 2> sizes[4] = {{1, 1}, {8, 8}, {37, 90}, {300, 5}};
    for (const auto& size : sizes) {
        const auto texture = test::make_noise(size[0], size[1], 1, size[0]);
        const BoundsPyramid pyramid = BoundsPyramid::build(*texture);
        EXPECT_GT(pyramid.byte_count(), 0u);
        const std::array<float, 3> black = {7, 8, 9};
        for (int round = 0; round < 300; ++round) {
            const auto choose = [&](uint32_t range) {
                return int64_t(random() % (4 * range)) - 2 * int64_t(range);
            };
            const int64_t x0 = choose(size[0]), x1 = x0 + int64_t(random() % (2 * size[0]));
            const int64_t y0 = choose(size[1]), y1 = y0 + int64_t(random() % 20);
            const WrapMode wrap = WrapMode(round % 4);
            const ChannelRange range = pyramid.query(x0, y0, x1, y1, wrap, black);
            for (int64_t y = y0; y <= y1; ++y)
                for (int64_t x = x0; x <= x1; ++x) {
                    const int64_t column = wrap_index(x, size[0], wrap), row = wrap_index(y, size[1], wrap);
                    const auto texel = column < 0 || row < 0 ? black : read_texel(*texture, column, row);
                    for (int c = 0; c < 3; ++c) {
                        ASSERT_LE(range.low[c], texel[c]);
                        ASSERT_GE(range.high[c], texel[c]);
                    }
                }
        }
    }
}

} // namespace

} // namespace relief
