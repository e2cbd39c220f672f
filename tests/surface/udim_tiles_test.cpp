// Tiles of UDIM maps beside each other: what filters read across their borders, and faces across several.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "scene/tile_use.h"
#include "surface/map/tile_texels.h"
#include "surface/test_scenes.h"

namespace relief {

namespace {

/// Displaces along z by `low` at u = 0 to `high` at u = 1, as texel centres sample it.
std::shared_ptr<Texture> make_ramp(uint32_t width, float low, float high) {
    auto texture = test::make_constant(width, 4, {0, 0, 0});
    for (size_t k = 0; k < size_t(width) * 4; ++k)
        texture->floats[4 * k + 2] = low + (high - low) * (float(k % width) + 0.5f) / float(width);
    return texture;
}

Displacement make_tiles(std::vector<MapTile> tiles) {
    Displacement displacement = test::make_displacement(nullptr);
    displacement.space = DisplacementSpace::object, displacement.is_udim = true;
    displacement.tiles = std::move(tiles);
    return displacement;
}

/// Two quads in the plane z = 0, x from 0 to 2, whose uvs are x + `shift` and y.
Mesh make_two_quads(float shift = 0) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    test::add_face(mesh, {0, 1, 2, 3}, {{shift, 0}, {1 + shift, 0}, {1 + shift, 1}, {shift, 1}});
    test::add_face(mesh, {1, 4, 5, 2}, {{1 + shift, 0}, {2 + shift, 0}, {2 + shift, 1}, {1 + shift, 1}});
    return mesh;
}

/// Height at (x, 1/2) of the surface on make_two_quads(), x a multiple of 1/32.
float find_height(const Surface& surface, float x) {
    const uint32_t patch = x < 1 ? 0 : 1;
    return evaluate_vertex(surface, patch, {5, {5, 5, 5, 5}}, uint32_t((x - float(patch)) * 32), 16).z;
}

TEST(UdimTiles, continue_each_other_where_the_mesh_goes_on) {
    for (const MapFilter filter : {MapFilter::none, MapFilter::bspline, MapFilter::cubic})
        for (const bool is_flipped : {false, true}) {
            Displacement displacement =
                make_tiles({{1001, make_ramp(16, 0, 1)}, {1002, make_ramp(16, 1, 2)}});
            displacement.filter = filter, displacement.flip_v = is_flipped;
            const Surface surface = make_surface(make_two_quads(), &displacement, {});
            for (float x = 0.75f; x <= 1.25f; x += 1.0f / 32)
                EXPECT_NEAR(find_height(surface, x), x, 2e-6f) << x << " filter " << int(filter);
        }
}

TEST(UdimTiles, continue_each_other_where_points_nearly_coincide) {
    Mesh mesh = make_two_quads();
    for (const uint32_t corner : {4u, 7u}) { // those at x = 1 of the second quad
        Vec3f p = mesh.positions[mesh.position_indices[corner]];
        p.x += 2e-7f;
        mesh.position_indices[corner] = uint32_t(mesh.positions.size());
        mesh.positions.push_back(p);
    }
    const Displacement displacement = make_tiles({{1001, make_ramp(16, 0, 1)}, {1002, make_ramp(16, 1, 2)}});
    const Surface surface = make_surface(mesh, &displacement, {});
    for (float x = 0.75f; x <= 1.25f; x += 1.0f / 32) EXPECT_NEAR(find_height(surface, x), x, 2e-6f) << x;
}

/// A number as large plus 1 is the same number, so that a loop over squares would not end.
TEST(UdimTiles, faces_far_away_in_uv_have_no_tile) {
    const Displacement displacement = make_tiles({{1001, make_ramp(4, 1, 2)}});
    for (const float far : {1e5f, 1e7f, 1e17f, 1e30f, -1e30f}) {
        Mesh mesh = make_two_quads();
        for (Vec2f& uv : mesh.uvs) uv = {uv.x * 0.5f, uv.y + far};
        const TileUse use = find_tile_use(mesh);
        EXPECT_EQ(use.outside, 2u) << far;
        EXPECT_TRUE(use.tiles.empty()) << far;
        if (std::fabs(far) < 1e6f) // others are refused
            EXPECT_EQ(find_height(make_surface(mesh, &displacement, {}), 0.5f), 0);
    }
}

TEST(UdimTiles, continue_each_other_along_v_as_well) {
    for (const bool is_flipped : {false, true}) {
        Mesh mesh = test::make_plane();
        mesh.positions.insert(mesh.positions.end(), {{1, 2, 0}, {0, 2, 0}});
        test::add_face(mesh, {3, 2, 4, 5}, {{0, 1}, {1, 1}, {1, 2}, {0, 2}});
        const auto make_rows = [&](float low) {
            auto texture = test::make_constant(2, 8, {0, 0, 0});
            for (size_t k = 0; k < 16; ++k) {
                const size_t row = is_flipped ? k / 2 : 7 - k / 2;
                texture->floats[4 * k + 2] = low + (float(row) + 0.5f) / 8;
            }
            return texture;
        };
        Displacement displacement = make_tiles({{1001, make_rows(0)}, {1011, make_rows(1)}});
        displacement.flip_v = is_flipped;
        const Surface surface = make_surface(mesh, &displacement, {});
        const PatchLevels levels{5, {5, 5, 5, 5}};
        for (uint32_t j = 20; j <= 32; ++j) {
            EXPECT_NEAR(evaluate_vertex(surface, 0, levels, 16, j).z, float(j) / 32, 1e-6f);
            EXPECT_NEAR(evaluate_vertex(surface, 1, levels, 16, 32 - j).z, 1 + float(32 - j) / 32, 1e-6f);
        }
    }
}

TEST(UdimTiles, of_two_sizes_continue_each_other) {
    const Displacement displacement = make_tiles({{1001, make_ramp(16, 0, 1)}, {1002, make_ramp(64, 1, 2)}});
    const Surface surface = make_surface(make_two_quads(), &displacement, {});
    for (float x = 0.5f; x <= 1.5f; x += 1.0f / 32) EXPECT_NEAR(find_height(surface, x), x, 2e-6f) << x;
}

TEST(UdimTiles, end_where_the_mesh_does_not_go_on_in_the_next_one) {
    Mesh mesh = make_two_quads();
    // The second quad lies elsewhere, with points of its own.
    for (int k = 0; k < 4; ++k) mesh.positions.push_back({5.0f + float(k == 1 || k == 2), float(k >= 2), 0});
    for (uint32_t k = 0; k < 4; ++k) mesh.position_indices[4 + k] = 6 + k;
    const Displacement displacement = make_tiles(
        {{1001, test::make_constant(4, 4, {0, 0, 1})}, {1002, test::make_constant(4, 4, {0, 0, 5})}});
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(find_height(surface, 31.0f / 32), 1);
    EXPECT_EQ(evaluate_vertex(surface, 0, {5, {5, 5, 5, 5}}, 32, 16).z, 1);
    EXPECT_EQ(find_height(surface, 1), 5);
}

TEST(UdimTiles, displace_each_sample_of_a_face_across_them_by_its_own_tile) {
    const Displacement displacement = make_tiles(
        {{1001, test::make_constant(4, 4, {0, 0, 0.1f})}, {1002, test::make_constant(4, 4, {0, 0, 0.2f})}});
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv.x += 0.5f;
    const Surface surface = make_surface(mesh, &displacement, {});
    const PatchLevels levels{4, {4, 4, 4, 4}};
    for (uint32_t i = 0; i <= 16; ++i)
        for (const uint32_t j : {0u, 7u, 16u}) {
            const float z = evaluate_vertex(surface, 0, levels, i, j).z;
            if (i <= 6) EXPECT_FLOAT_EQ(z, 0.1f) << i; // half a texel from the border
            if (i == 8) EXPECT_FLOAT_EQ(z, 0.15f);
            if (i >= 10) EXPECT_FLOAT_EQ(z, 0.2f) << i;
        }
}

TEST(UdimTiles, that_are_missing_displace_nothing_in_a_face_across_them) {
    const Displacement displacement = make_tiles({{1001, test::make_constant(256, 4, {0, 0, 1})}});
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv.x += 0.75f; // the middle is in the missing tile
    const Surface surface = make_surface(mesh, &displacement, {});
    const PatchLevels levels{4, {4, 4, 4, 4}};
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, 2, 8).z, 1);
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, 4, 8).z, 1);
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, 5, 8).z, 0);
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, 14, 8).z, 0);
}

/// However many tiles a face lies across, those that the map has displace their samples.
TEST(UdimTiles, displace_their_part_of_a_face_across_many_squares) {
    const Displacement displacement = make_tiles({{1001, test::make_constant(256, 4, {0, 0, 1})}});
    const PatchLevels levels{7, {7, 7, 7, 7}};
    for (const auto& [from, to] : {std::pair(0.0f, 7.0f),
                                   {0.0f, 8.0f},
                                   {0.0f, 10.0f},
                                   {-100.0f, 5.0f},
                                   {0.0f, 100.0f},
                                   {-3.0f, 70.0f}}) {
        Mesh mesh = test::make_plane();
        for (Vec2f& uv : mesh.uvs) uv.x = from + (to - from) * uv.x;
        const Surface surface = make_surface(mesh, &displacement, {});
        for (uint32_t i = 0; i <= 128; ++i) {
            const float u = from + (to - from) * float(i) / 128;
            if (std::min(std::fabs(u), std::fabs(u - 1)) < 0.02f) continue; // filters read beyond the border
            EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, i, 8).z, u > 0 && u < 1) << u << ' ' << to;
        }
    }
}

TEST(UdimTiles, of_wide_faces_are_listed_from_the_first_to_the_last) {
    const auto find_use = [](Vec2f low, Vec2f high) {
        Mesh mesh = test::make_plane();
        for (Vec2f& uv : mesh.uvs) uv = {low.x + (high.x - low.x) * uv.x, low.y + (high.y - low.y) * uv.y};
        return find_tile_use(mesh);
    };
    const TileUse left = find_use({-100, 0}, {5, 1});
    EXPECT_EQ(left.outside, 0u) << "a part of it lies in tiles";
    EXPECT_EQ(left.crossing, 1u);
    EXPECT_EQ(left.tiles, (std::set{1001, 1002, 1003, 1004, 1005}));
    EXPECT_EQ(find_use({8, 0}, {1000, 2}).tiles, (std::set{1009, 1010, 1019, 1020}));
    EXPECT_EQ(find_use({-1e6f, -1e6f}, {1e6f, 1e6f}).tiles.size(), size_t(kLastUdim - kFirstUdim + 1));
    EXPECT_EQ(find_use({-9, 0}, {-2, 1}).outside, 1u);
    EXPECT_EQ(find_use({10, 0}, {12, 1}).outside, 1u);
    EXPECT_EQ(find_use({0, 900}, {1, 902}).outside, 1u);
    EXPECT_EQ(find_use({0, -5}, {1, -3}).outside, 1u);
}

TEST(UdimTiles, of_several_faces_add_up) {
    Mesh mesh = make_two_quads(3);
    EXPECT_EQ(find_tile_use(mesh).tiles, (std::set{1004, 1005}));
    for (size_t k = 4; k < 8; ++k) mesh.uvs[mesh.uv_indices[k]].y += 2;
    EXPECT_EQ(find_tile_use(mesh).tiles, (std::set{1004, 1025}));
}

TEST(UdimTiles, that_meet_in_a_corner_are_read_on_the_way_through_a_third_one) {
    DisplacementMap map;
    const auto add = [&](int udim, float z) {
        map.tiles.push_back({udim, test::make_constant(4, 4, {0, 0, z}), nullptr, nullptr});
    };
    add(1001, 1), add(1002, 2), add(1012, 3);
    constexpr TileIndex kNone = Surface::kNoTile;
    map.neighbours = {{kNone, 1, kNone, kNone}, {0, kNone, 2, kNone}, {kNone, kNone, kNone, 1}};
    EXPECT_EQ(read_beyond_tile(map, 0, 0, 4, -1)[2], 3);
    EXPECT_EQ(read_beyond_tile(map, 2, 0, -1, 4)[2], 1);
    EXPECT_EQ(read_beyond_tile(map, 0, 0, 5, 2)[2], 2);
    EXPECT_EQ(read_beyond_tile(map, 0, 0, 2, -1)[2], 1) << "the last tile on the way continues";
    EXPECT_EQ(read_beyond_tile(map, 0, 0, 2, -3)[2], 0) << "but not far";
}

TEST(UdimTiles, have_bounds_that_hold_every_corner_of_every_cell) {
    std::mt19937 random(7);
    for (uint32_t round = 0; round < 40; ++round) {
        Displacement displacement = make_tiles({{1001, test::make_noise(24, 24, 1, round)},
                                                {1002, test::make_noise(24, 24, 10, round + 1)},
                                                {1011, test::make_noise(24, 24, 100, round + 2)}});
        if (round % 3 == 0) displacement.tiles[1].texture = test::make_noise(41, 13, 10, round);
        if (round % 4 == 0) displacement.tiles.push_back({1012, test::make_noise(24, 24, 1000, round)});
        displacement.wrap = WrapMode(round % 4), displacement.flip_v = round % 5 == 0;
        displacement.filter = round % 2 == 0 ? MapFilter::none : MapFilter::bspline;
        displacement.midlevel = {0.5f, 0, 3};
        Mesh mesh = test::make_random_grid(3, 3, 0, round);
        for (Vec2f& uv : mesh.uvs) uv = {uv.x * 1.9f + 0.1f, uv.y * 1.8f + 0.15f};
        const Surface surface = make_surface(mesh, &displacement, {});
        const PatchLevels levels{4, {4, 2, 3, 4}};
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Box box = compute_patch_box(surface, patch);
            for (uint32_t j = 0; j <= 16; ++j)
                for (uint32_t i = 0; i <= 16; ++i)
                    ASSERT_TRUE(box.contains(evaluate_vertex(surface, patch, levels, i, j)))
                        << "round " << round;
        }
    }
}

TEST(UdimTiles, keep_edges_of_neighbours_the_same) {
    const Displacement displacement = make_tiles({{1001, test::make_noise(16, 16, 1, 1)},
                                                  {1002, test::make_noise(16, 16, 1, 2)},
                                                  {1003, test::make_noise(33, 20, 1, 3)}});
    for (const float shift : {0.0f, 0.4f}) {
        const Surface surface = make_surface(make_two_quads(shift), &displacement, {});
        const PatchLevels levels{5, {5, 5, 5, 5}};
        for (uint32_t j = 0; j <= 32; ++j)
            EXPECT_EQ(evaluate_vertex(surface, 0, levels, 32, j), evaluate_vertex(surface, 1, levels, 0, j));
    }
}

} // namespace

} // namespace relief
