// Filtered maps: their smaller copies, and which of them patches read.
#include "surface/map/mip_chain.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

#include "formulas/mips.h"
#include "surface/map/gutter.h"
#include "surface/map/texels.h"
#include "surface/patch/map_edit.h"
#include "surface/patch/patch_mips.h"
#include "surface/patch/patch_samples.h"
#include "test_scenes.h"

namespace relief {
namespace {

double sum_channel(const Texture& texture) {
    double sum = 0;
    for (size_t k = 1; k < texture.floats.size(); k += 4) sum += texture.floats[k];
    return sum;
}

/// A surface whose map is filtered, levels as a camera near one corner sees them.
struct FilteredGrid {
    Surface surface;
    LevelField levels;

    explicit FilteredGrid(DisplacementSpace space, uint32_t seed = 3) {
        Displacement displacement = test::make_displacement(test::make_noise(301, 256, 0.2f, seed));
        displacement.space = space, displacement.wrap = WrapMode::repeat;
        displacement.filter = MapFilter::mip;
        surface = make_surface(test::make_random_grid(7, 5, 0.4f, seed), &displacement, {});
        DisplacementMap::Tile& tile = surface.map.tiles[0];
        tile.mips = std::make_shared<MipChain>(*tile.texture, OutsideTexels{}, WrapMode::repeat);
        LevelFieldConfig config;
        config.camera = {-0.5f, -0.5f, 1};
        config.pixel_angle = 0.03f;
        levels = LevelField::compute(surface, {}, config);
        const LevelField* fields[] = {&levels};
        surface.mips = choose_mips(surface, fields);
    }
};

/// All of an image's texels are `value`, but for those outside of the islands that no fetch inside reads.
void expect_inside(const MipChain::Copy& copy, float value) {
    const Texture& texture = *copy.texture;
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x)
            if (!copy.is_outside[size_t(y) * texture.width + x])
                ASSERT_EQ(read_texel(texture, x, y)[0], value) << x << " " << y;
}

} // namespace

TEST(MipChain, copies_are_half_as_large_and_have_the_same_mean) {
    const auto even = test::make_noise(64, 16, 1, 5);
    const MipChain chain(*even, {}, WrapMode::clamp);
    ASSERT_EQ(chain.count(), 6u);
    const Texture* larger = even.get();
    for (uint32_t mip = 1; mip <= chain.count(); ++mip) {
        const Texture& copy = *chain.copy(mip).texture;
        EXPECT_EQ(copy.width, std::max(1u, larger->width / 2));
        EXPECT_EQ(copy.height, std::max(1u, larger->height / 2));
        EXPECT_NEAR(sum_channel(copy) / copy.width / copy.height, sum_channel(*even) / 64 / 16, 1e-6);
        larger = &copy;
    }
    EXPECT_EQ(chain.copy(7).texture, chain.copy(6).texture);
    EXPECT_EQ(
        chain.copy(1).texture->floats[0],
        float((double(even->floats[0]) + even->floats[4] + even->floats[64 * 4] + even->floats[65 * 4]) / 4));
}

TEST(MipChain, of_an_odd_size_weighs_texels_by_their_share) {
    const auto odd = test::make_constant(3, 1, {0, 0, 0});
    odd->floats[0] = 3, odd->floats[4] = 6, odd->floats[8] = 12;
    const MipChain chain(*odd, {}, WrapMode::clamp);
    EXPECT_EQ(chain.copy(1).texture->floats[0], 4);
    EXPECT_EQ(chain.copy(1).texture->floats[4], 10);
}

TEST(MipChain, background_does_not_bleed_into_islands) {
    Mesh mesh = test::make_plane();
    mesh.uvs = {{0.2f, 0.15f}, {0.7f, 0.25f}, {0.75f, 0.8f}, {0.22f, 0.78f}};
    Displacement displacement = test::make_displacement(test::make_constant(96, 80, {9, 9, 9}));
    const UvOutlines outlines = make_uv_outlines(mesh);
    const UvOutlines* meshes[] = {&outlines};
    auto map = std::make_shared<Texture>(*displacement.tiles[0].texture);
    UvIslands islands(displacement, displacement.tiles[0]);
    islands.add(outlines);
    islands.visit_covered([](int64_t, int64_t) { return true; },
                          [&](int64_t x, int64_t y) { map->floats[4 * size_t(y * 96 + x)] = 1; });
    displacement.tiles[0].texture = map;
    const OutsideTexels outside = find_outside_texels(displacement, displacement.tiles[0], meshes);
    EXPECT_TRUE(outside.holds(*map, 0, 0));
    EXPECT_FALSE(outside.holds(*map, 40, 40));
    const MipChain chain(*map, outside, WrapMode::clamp);
    for (uint32_t mip = 1; mip <= chain.count(); ++mip) expect_inside(chain.copy(mip), 1);
    const MipChain mixed(*map, {}, WrapMode::clamp);
    EXPECT_GT(mixed.copy(4).texture->floats[4 * (2 * 6 + 1)], 1);
    // Beside the island: what bilinear fetches inside of it read.
    displacement.filter = MapFilter::mip;
    displacement.space = DisplacementSpace::object;
    Surface surface = make_surface(mesh, &displacement, {});
    surface.map.tiles[0].mips = std::make_shared<MipChain>(chain);
    for (uint32_t mip = 1; mip <= chain.count(); ++mip) {
        surface.mips = {scalar::pack_mip(mip, scalar::kMipInside)};
        for (uint32_t j = 1; j < 32; ++j)
            for (uint32_t i = 1; i < 32; ++i) {
                const Vec3f p = evaluate_vertex(surface, 0, {5, {5, 5, 5, 5}}, i, j);
                ASSERT_NEAR(p.x - float(i) / 32, 1, 1e-5f) << "copy " << mip;
            }
    }
}

TEST(MipChain, a_map_without_background_is_averaged_as_it_is) {
    // A checkerboard goes on between the islands: half of the texels there hold one value, not more.
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv = {0.27f + 0.46f * uv.x, 0.27f + 0.46f * uv.y};
    Displacement displacement = test::make_displacement(test::make_constant(64, 64, {0, 0, 0}));
    auto map = std::make_shared<Texture>(*displacement.tiles[0].texture);
    for (uint32_t k = 0; k < 64 * 64; ++k) map->floats[4 * k] = (k + k / 64) % 2 ? 1 : -1;
    displacement.tiles[0].texture = map;
    UvOutlines outlines = make_uv_outlines(mesh);
    const UvOutlines* meshes[] = {&outlines};
    EXPECT_TRUE(find_outside_texels(displacement, displacement.tiles[0], meshes).uncovered.is_empty());
    // A face over many periods covers everything, and that is known at once.
    displacement.wrap = WrapMode::repeat;
    for (Vec2f& uv : mesh.uvs) uv = {uv.x * 5000, uv.y * 90};
    outlines = make_uv_outlines(mesh);
    for (size_t k = 0; k < map->floats.size(); ++k) map->floats[k] = 0;
    EXPECT_TRUE(find_outside_texels(displacement, displacement.tiles[0], meshes).uncovered.is_empty());
    EXPECT_TRUE(find_gutter(displacement, displacement.tiles[0], meshes).copies.empty());
}

/// One sheet of nine quads with bulging borders, which smooth uvs pull in.
Mesh make_bulging_sheet(int level) {
    Mesh mesh = test::make_random_grid(3, 3, 0, 2);
    for (Vec2f& uv : mesh.uvs) {
        const float x = 2 * uv.x - 1, y = 2 * uv.y - 1;
        const float bulge = (std::fabs(x) > 0.9f) != (std::fabs(y) > 0.9f) ? 0.375f : 0.25f;
        uv = {0.5f + bulge * x, 0.5f + bulge * y};
    }
    mesh.subdivision.scheme = SubdivisionScheme::catmark, mesh.subdivision.level = level;
    return mesh;
}

TEST(MipChain, islands_of_automatic_levels_are_those_of_fine_ones) {
    const Displacement displacement = test::make_displacement(test::make_constant(256, 256, {0, 0, 0}));
    std::vector<TexelMask> masks;
    for (const int level : {kAutoSubdivisionLevel, 5, 0}) {
        const Mesh mesh = make_bulging_sheet(level);
        const UvOutlines outlines = make_uv_outlines(mesh);
        const UvOutlines* meshes[] = {&outlines};
        masks.push_back(find_outside_texels(displacement, displacement.tiles[0], meshes).uncovered);
    }
    int differences = 0, of_straight_borders = 0;
    for (int64_t y = 0; y < 256; ++y)
        for (int64_t x = 0; x < 256; ++x) {
            differences += masks[0].has(x, y) != masks[1].has(x, y);
            of_straight_borders += masks[2].has(x, y) != masks[1].has(x, y);
        }
    EXPECT_LT(differences, 30);
    EXPECT_GT(of_straight_borders, 100);
}

TEST(MipChain, islands_are_those_of_the_subdivided_uvs) {
    Mesh mesh = make_bulging_sheet(3);
    Displacement displacement = test::make_displacement(test::make_constant(256, 256, {0, 0, 0}));
    displacement.space = DisplacementSpace::object;
    const Surface surface = make_surface(mesh, &displacement, {});
    auto map = std::make_shared<Texture>(*displacement.tiles[0].texture);
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const PatchSamples samples(surface, patch);
        for (float v = 0.02f; v < 1; v += 0.04f)
            for (float u = 0.02f; u < 1; u += 0.04f) {
                const Vec2f uv = blend_corners(samples.corners(), u, v).uv;
                map->floats[4 * (size_t((1 - uv.y) * 256) * 256 + size_t(uv.x * 256)) + 2] = 1;
            }
    }
    displacement.tiles[0].texture = map;
    const UvOutlines outlines = make_uv_outlines(mesh);
    const UvOutlines* meshes[] = {&outlines};
    const OutsideTexels outside = find_outside_texels(displacement, displacement.tiles[0], meshes);
    ASSERT_FALSE(outside.uncovered.is_empty());
    const MipChain chain(*map, outside, WrapMode::clamp);
    const MipChain::Copy& copy = chain.copy(3);
    for (uint32_t k = 0; k < 32 * 32; ++k)
        if (!copy.is_outside[k]) ASSERT_GT(copy.texture->floats[4 * k + 2], 0.9f) << k % 32 << " " << k / 32;
}

TEST(MipChain, follows_edits_as_if_made_anew) {
    std::mt19937 random(4);
    for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat}) {
        auto map = test::make_noise(75, 50, 1, 6);
        OutsideTexels outside{TexelMask(*map), {}};
        for (uint32_t y = 0; y < 50; ++y)
            for (uint32_t x = 0; x < 75; ++x) {
                if (x > 12 && x < 40 && y > 8) continue;
                outside.uncovered.set(x, y);
                for (size_t c = 0; c < 3; ++c) map->floats[4 * (y * 75 + x) + c] = 0;
            }
        MipChain chain(*map, outside, wrap);
        for (int round = 0; round < 12; ++round) {
            const uint32_t x0 = random() % 70, y0 = random() % 45;
            const TexelRectangle changed{x0, y0, x0 + uint32_t(random() % (75 - x0)),
                                         y0 + uint32_t(random() % (50 - y0))};
            for (uint32_t y = changed.y0; y <= changed.y1; ++y)
                for (uint32_t x = changed.x0; x <= changed.x1; ++x)
                    map->floats[4 * (y * 75 + x)] = round % 3 == 0 ? 0 : float(random() % 100);
            std::vector<Texture> before;
            for (uint32_t mip = 1; mip <= chain.count(); ++mip) before.push_back(*chain.copy(mip).texture);
            const auto rectangles = chain.update(*map, changed);
            const MipChain fresh(*map, outside, wrap);
            ASSERT_EQ(rectangles.size(), chain.count());
            for (uint32_t mip = 1; mip <= chain.count(); ++mip) {
                const Texture& copy = *chain.copy(mip).texture;
                ASSERT_EQ(copy.floats, fresh.copy(mip).texture->floats) << "copy " << mip;
                const TexelRectangle& r = rectangles[mip - 1];
                for (uint32_t k = 0; k < copy.width * copy.height; ++k) {
                    const uint32_t x = k % copy.width, y = k / copy.width;
                    if (x < r.x0 || x > r.x1 || y < r.y0 || y > r.y1)
                        ASSERT_EQ(copy.floats[4 * k], before[mip - 1].floats[4 * k]);
                }
            }
        }
    }
}

TEST(PatchMips, agree_wherever_patches_meet) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent}) {
        const FilteredGrid grid(space);
        const Surface& surface = grid.surface;
        std::map<std::pair<uint32_t, uint32_t>, std::vector<Vec3f>> edges;
        std::set<uint32_t> words;
        int shared = 0, mixed = 0;
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const uint32_t word = surface.mips[patch];
            words.insert(word);
            for (uint32_t place = 1; place < 9; ++place)
                mixed += scalar::packed_mip(word, place) != scalar::packed_mip(word, scalar::kMipInside);
            for (int k = 0; k < 4; ++k) {
                const Quad quad = surface.quads[patch];
                const uint32_t a = surface.dominant(quad.vertex[k]),
                               b = surface.dominant(quad.vertex[(k + 1) & 3]);
                std::vector<Vec3f> points =
                    test::drop_repeats(test::evaluate_edge(surface, patch, grid.levels.at(patch), k));
                if (a > b) std::reverse(points.begin(), points.end());
                const auto [place, is_new] = edges.try_emplace(std::minmax(a, b), points);
                if (is_new) continue;
                ++shared;
                ASSERT_EQ(place->second, points) << "patch " << patch << " edge " << k;
            }
        }
        EXPECT_GT(shared, 40);
        EXPECT_GT(words.size(), 5u);
        EXPECT_GT(mixed, 20);
    }
}

TEST(PatchMips, agree_where_tiles_of_other_sizes_meet) {
    Mesh mesh;
    mesh.name = "row";
    for (uint32_t x = 0; x <= 3; ++x)
        for (uint32_t y = 0; y <= 1; ++y) mesh.positions.push_back({float(x), float(y), 0});
    for (uint32_t x = 0; x < 3; ++x) {
        const float u = float(x);
        test::add_face(mesh, {2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1},
                       {{u, 0}, {u + 1, 0}, {u + 1, 1}, {u, 1}});
    }
    Displacement displacement = test::make_displacement(test::make_noise(1024, 1024, 1, 4));
    displacement.tiles.push_back({1002, test::make_noise(64, 64, 1, 5)}); // 1003 has no file
    displacement.is_udim = true, displacement.space = DisplacementSpace::object;
    displacement.filter = MapFilter::mip;
    Surface surface = make_surface(mesh, &displacement, {});
    for (DisplacementMap::Tile& tile : surface.map.tiles)
        tile.mips = std::make_shared<MipChain>(*tile.texture, OutsideTexels{}, WrapMode::clamp);
    LevelFieldConfig config;
    config.fixed_level = 4;
    const LevelField field = LevelField::compute(surface, {}, config);
    const LevelField* fields[] = {&field};
    surface.mips = choose_mips(surface, fields);
    for (uint32_t patch = 0; patch + 1 < 3; ++patch) {
        std::vector<Vec3f> left = test::evaluate_edge(surface, patch, field.at(0), 1);
        std::vector<Vec3f> right = test::evaluate_edge(surface, patch + 1, field.at(0), 3);
        std::reverse(right.begin(), right.end());
        EXPECT_EQ(left, right) << patch;
    }
    for (uint32_t place = 0; place < 9; ++place)
        EXPECT_EQ(scalar::packed_mip(surface.mips[0], place), 6u) << "64 texels a cell; place " << place;
}

TEST(PatchMips, have_texels_about_as_large_as_cells) {
    Displacement displacement = test::make_displacement(test::make_noise(1024, 1024, 1, 2));
    displacement.space = DisplacementSpace::object, displacement.filter = MapFilter::mip;
    Surface surface = make_surface(test::make_plane(), &displacement, {});
    DisplacementMap::Tile& tile = surface.map.tiles[0];
    tile.mips = std::make_shared<MipChain>(*tile.texture, OutsideTexels{}, WrapMode::clamp);
    for (const int level : {12, 10, 9, 6, 3, 0}) {
        LevelFieldConfig config;
        config.fixed_level = level;
        const LevelField field = LevelField::compute(surface, {}, config);
        const LevelField* fields[] = {&field};
        const uint32_t word = choose_mips(surface, fields)[0];
        for (uint32_t place = 0; place < 9; ++place)
            EXPECT_EQ(scalar::packed_mip(word, place), uint32_t(std::clamp(10 - level, 0, 7))) << level;
    }
    // Of two instances the finer one decides.
    LevelFieldConfig coarse, fine;
    coarse.fixed_level = 2, fine.fixed_level = 8;
    const LevelField a = LevelField::compute(surface, {}, coarse), b = LevelField::compute(surface, {}, fine);
    const LevelField* fields[] = {&a, &b};
    EXPECT_EQ(scalar::packed_mip(choose_mips(surface, fields)[0], scalar::kMipInside), 2u);
}

TEST(PatchMips, take_away_what_the_cells_cannot_show) {
    const auto map = test::make_noise(1024, 1024, 1, 8);
    Displacement displacement = test::make_displacement(map);
    displacement.space = DisplacementSpace::object;
    Surface plain = make_surface(test::make_plane(), &displacement, {});
    displacement.filter = MapFilter::mip;
    Surface filtered = make_surface(test::make_plane(), &displacement, {});
    filtered.map.tiles[0].mips = std::make_shared<MipChain>(*map, OutsideTexels{}, WrapMode::clamp);
    LevelFieldConfig config;
    config.fixed_level = 5;
    const LevelField field = LevelField::compute(filtered, {}, config);
    const LevelField* fields[] = {&field};
    filtered.mips = choose_mips(filtered, fields);
    const auto measure = [&](const Surface& surface) {
        double sum = 0;
        for (uint32_t k = 0; k < 31 * 31; ++k) {
            const float z = evaluate_vertex(surface, 0, field.at(0), 1 + k % 31, 1 + k / 31).z;
            sum += double(z) * z;
        }
        return std::sqrt(sum / (31 * 31));
    };
    // The mean of 32 x 32 independent values spreads a 32nd as far, less still between texels.
    EXPECT_GT(measure(plain), 0.25);
    EXPECT_LT(measure(filtered), 0.03);
    EXPECT_GT(measure(filtered), 0.003);
}

TEST(PatchMips, autobump_shades_by_the_map_itself) {
    Displacement displacement = test::make_displacement(test::make_noise(256, 256, 0.002f, 8));
    displacement.space = DisplacementSpace::tangent;
    const Surface plain = make_surface(test::make_plane(), &displacement, {});
    displacement.autobump = true;
    Surface bumped = make_surface(test::make_plane(), &displacement, {});
    LevelFieldConfig config;
    config.fixed_level = 3;
    const LevelField field = LevelField::compute(bumped, {}, config);
    const LevelField* fields[] = {&field};
    bumped.mips = choose_mips(bumped, fields);
    for (const Vec2f at : {Vec2f{0.31f, 0.42f}, Vec2f{0.77f, 0.13f}}) {
        const Vec3f expected = compute_shading_normal(plain, 0, 8, at.x, at.y);
        EXPECT_EQ(compute_shading_normal(bumped, 0, 3, at.x, at.y), expected);
        EXPECT_FALSE(compute_shading_normal(plain, 0, 3, at.x, at.y) == expected);
        EXPECT_EQ(evaluate_vertex(bumped, 0, field.at(0), 3, 5),
                  evaluate_vertex(plain, 0, field.at(0), 3, 5));
    }
}

TEST(PatchMips, tell_which_patches_an_edit_of_a_filtered_map_reaches) {
    FilteredGrid grid(DisplacementSpace::object, 12);
    Surface& surface = grid.surface;
    DisplacementMap::Tile& tile = surface.map.tiles[0];
    auto map = std::make_shared<Texture>(*tile.texture);
    auto chain = std::make_shared<MipChain>(*map, OutsideTexels{}, WrapMode::repeat);
    tile.texture = map, tile.mips = chain;
    const auto evaluate = [&] {
        std::vector<Vec3f> points;
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
            for (uint32_t j = 0; j <= 1u << grid.levels.at(patch).patch; ++j)
                for (uint32_t i = 0; i <= 1u << grid.levels.at(patch).patch; ++i) {
                    points.push_back(evaluate_vertex(surface, patch, grid.levels.at(patch), i, j));
                    points.push_back({float(patch), 0, 0});
                }
        return points;
    };
    const std::vector<Vec3f> before = evaluate();
    const TexelRectangle changed{140, 100, 150, 104};
    for (uint32_t y = changed.y0; y <= changed.y1; ++y)
        for (uint32_t x = changed.x0; x <= changed.x1; ++x) map->floats[4 * (y * 301 + x)] = 20;
    std::vector<TexelRectangle> rectangles = chain->update(*map, changed);
    rectangles.insert(rectangles.begin(), changed);
    const std::vector<uint8_t> touched = find_touched_patches(surface, 0, rectangles);
    EXPECT_LT(std::accumulate(touched.begin(), touched.end(), 0), int(surface.patch_count()));
    const std::vector<Vec3f> after = evaluate();
    int moved = 0;
    for (size_t k = 0; k < before.size(); k += 2) {
        if (before[k] == after[k]) continue;
        ++moved;
        ASSERT_EQ(touched[size_t(before[k + 1].x)], 1) << "patch " << before[k + 1].x;
    }
    EXPECT_GT(moved, 10);
}

} // namespace relief
