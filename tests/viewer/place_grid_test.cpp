// Places of faces on the grid of a tile, however far uvs reach and however often they overlap.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "viewer/fixture.h"
#include "viewer/place_grid.h"
#include "viewer/texel_places.h"

namespace relief::viewer {

namespace {

/// A square with x and y in [0, 1] whose uvs span [low, high].
Mesh make_square(const Vec2f& low, const Vec2f& high) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.uvs = {low, {high.x, low.y}, high, {low.x, high.y}};
    mesh.face_sizes = {4};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    return mesh;
}

/// Samples of the grid that have a place, and all of them.
struct Count {
    int there = 0, all = 0;
};

Count count_places(const PlaceGrid& grid) {
    Count count;
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x)
            ++count.all, count.there += grid.find(float(x) + 0.5f, float(y) + 0.5f).has_value();
    return count;
}

} // namespace

TEST(PlaceGrid, holds_places_by_rows_from_either_end) {
    for (const bool flip_v : {false, true}) {
        PlaceGrid grid(16, 8);
        grid.draw(make_square({0, 0}, {1, 1}), {.flip_v = flip_v});
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 16; ++x) {
                const auto place = grid.find(float(x) + 0.5f, float(y) + 0.5f);
                ASSERT_TRUE(place);
                const float row = (float(y) + 0.5f) / 8;
                EXPECT_NEAR(place->x, (float(x) + 0.5f) / 16, 1e-5f);
                EXPECT_NEAR(place->y, flip_v ? row : 1 - row, 1e-5f);
            }
    }
}

/// Without a bound the second one visits 10^18 samples.
TEST(PlaceGrid, of_a_map_that_repeats_is_full_however_often_it_does) {
    for (const float reach : {100.0f, 1e6f}) {
        PlaceGrid grid(1024, 1024);
        grid.draw(make_square({-reach, -reach}, {reach, reach}), {});
        const Count count = count_places(grid);
        EXPECT_EQ(count.there, count.all) << reach;
    }
}

/// A place of a repeated map is one of those that the face has for its uv.
TEST(PlaceGrid, of_a_map_that_repeats_has_places_of_the_face) {
    PlaceGrid grid(64, 64);
    grid.draw(make_square({0, 0}, {5, 5}), {});
    for (const float column : {0.5f, 20.5f, 63.5f}) {
        const auto place = grid.find(column, 30.5f);
        ASSERT_TRUE(place);
        const float u = 5 * place->x, v = 5 * place->y;
        EXPECT_NEAR(u - std::floor(u), column / 64, 1e-4f);
        EXPECT_NEAR(v - std::floor(v), 1 - 30.5f / 64, 1e-4f);
    }
}

/// Each face with the whole square: one by one they would visit 10^11 samples.
TEST(PlaceGrid, ends_soon_where_uvs_overlap_often) {
    for (const float low : {0.0f, 0.25f}) {
        Mesh mesh = make_square({low, 0}, {1, 1});
        for (int copy = 0; copy < 100'000; ++copy) {
            mesh.face_sizes.push_back(4);
            for (uint32_t k = 0; k < 4; ++k) mesh.position_indices.push_back(k), mesh.uv_indices.push_back(k);
        }
        PlaceGrid grid(1024, 1024);
        grid.draw(mesh, {});
        EXPECT_GE(count_places(grid).there, int(float(grid.width() * grid.height()) * (1 - low)));
    }
}

TEST(TexelPlaces, draw_tiles_when_they_are_asked_for) {
    Scene scene = make_bumpy_scene(DisplacementSpace::object);
    Displacement& map = scene.displacements[0];
    map.is_udim = true;
    for (int tile = 1002; tile < 1200; ++tile) map.tiles.push_back({tile, map.tiles[0].texture});
    const TexelPlaces places(scene, 0);
    EXPECT_EQ(places.drawn_tiles(), 0u);
    EXPECT_TRUE(places.find(map, map.tiles[0], 10, 10));
    EXPECT_EQ(places.drawn_tiles(), 1u);
    EXPECT_FALSE(places.find(map, map.tiles[1], 10, 10)) << "no face is there";
    EXPECT_EQ(places.drawn_tiles(), 2u);
}

TEST(TexelFrames, of_many_tiles_take_no_more_than_those_of_a_few) {
    Scene scene = make_bumpy_scene(DisplacementSpace::tangent);
    Displacement& map = scene.displacements[0];
    EXPECT_EQ(TexelFrames(map, scene.meshes[0]).side(), 256u);
    map.is_udim = true;
    for (int tile = 1002; tile < 1201; ++tile) map.tiles.push_back({tile, map.tiles[0].texture});
    const TexelFrames frames(map, scene.meshes[0]);
    EXPECT_EQ(frames.side(), 64u);
    const Vec3f normal = frames.express({0, 0, 1}, 1001, 0.3f, 0.7f);
    EXPECT_NEAR(normal.z, 1, 1e-5f);
}

TEST(PlaceGrid, of_a_tile_has_its_part_of_a_face_across_several) {
    const Mesh mesh = make_square({0.5f, 0}, {2.25f, 1});
    for (const int column : {0, 1, 2, 3}) {
        PlaceGrid grid(64, 64);
        grid.draw(mesh, {.has_tiles = true, .square = {column, 0}});
        for (int x = 0; x < 64; ++x) {
            const float u = float(column) + (float(x) + 0.5f) / 64;
            const auto place = grid.find(float(x) + 0.5f, 31.5f);
            ASSERT_EQ(place.has_value(), u > 0.5f - 1.5f / 64 && u < 2.25f + 1.5f / 64) << u;
            if (place) EXPECT_NEAR(place->x, (u - 0.5f) / 1.75f, 1e-4f) << u;
        }
    }
    PlaceGrid above(64, 64);
    above.draw(mesh, {.has_tiles = true, .square = {0, 1}});
    EXPECT_EQ(count_places(above).there, 0);
}

} // namespace relief::viewer
