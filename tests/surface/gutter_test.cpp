// Texels between uv islands: which are read, and what they are given.
#include "surface/map/gutter.h"

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "surface/mesh/uv_islands.h"
#include "surface/mesh/uv_outlines.h"
#include "surface/patch/patch_samples.h"
#include "test_scenes.h"

namespace relief {
namespace {

constexpr uint32_t kSize = 64;

/// Two quads with a common edge, whose uvs are two tilted squares apart from each other.
Mesh make_islands(float gap) {
    Mesh mesh;
    mesh.name = "islands";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
    const float left = 0.5f - gap, right = 0.5f + gap;
    test::add_face(mesh, {0, 1, 4, 5}, {{0.1f, 0.15f}, {left, 0.1f}, {left - 0.03f, 0.8f}, {0.07f, 0.9f}});
    test::add_face(mesh, {1, 2, 3, 4}, {{right, 0.1f}, {0.9f, 0.2f}, {0.93f, 0.85f}, {right - 0.03f, 0.8f}});
    return mesh;
}

bool is_inside(const Mesh& mesh, uint32_t face, double u, double v) {
    for (uint32_t k = 0; k < 4; ++k) {
        const Vec2f &a = mesh.uvs[4 * face + k], &b = mesh.uvs[4 * face + (k + 1) % 4];
        if ((double(b.x) - a.x) * (v - a.y) - (double(b.y) - a.y) * (u - a.x) < 0) return false;
    }
    return true;
}

/// `inside` where a centre lies in an island, `background` elsewhere.
std::shared_ptr<Texture> make_map(const Mesh& mesh, const Vec3f& inside, const Vec3f& background) {
    auto map = test::make_constant(kSize, kSize, background);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x) {
            const double u = (x + 0.5) / kSize, v = 1 - (y + 0.5) / kSize;
            if (!is_inside(mesh, 0, u, v) && !is_inside(mesh, 1, u, v)) continue;
            for (int c = 0; c < 3; ++c) map->floats[4 * (y * kSize + x) + c] = get_component(inside, c);
        }
    return map;
}

GutterFill find(const Displacement& displacement, const Mesh& mesh) {
    const UvOutlines outlines = make_uv_outlines(mesh);
    const UvOutlines* meshes[] = {&outlines};
    return find_gutter(displacement, displacement.tiles[0], meshes);
}

/// Least z of all samples of a surface whose map lifts it along z.
float find_lowest(const Mesh& mesh, std::shared_ptr<const Texture> map) {
    Displacement displacement = test::make_displacement(std::move(map));
    displacement.space = DisplacementSpace::object;
    const Surface surface = make_surface(mesh, &displacement, {});
    float lowest = INFINITY;
    for (uint32_t patch = 0; patch < 2; ++patch)
        for (uint32_t j = 0; j <= 64; ++j)
            for (uint32_t i = 0; i <= 64; ++i)
                lowest = std::min(lowest, evaluate_vertex(surface, patch, {6, {6, 6, 6, 6}}, i, j).z);
    return lowest;
}

} // namespace

TEST(Gutter, background_does_not_bleed_into_the_surface) {
    for (const Vec3f background : {Vec3f{0, 0, 0}, Vec3f{0.5f, -1, 0.25f}}) {
        const Mesh mesh = make_islands(0.1f);
        const auto map = make_map(mesh, {0, 0, 1}, background);
        EXPECT_LT(find_lowest(mesh, map), 0.7f);
        GutterFill fill = find(test::make_displacement(map), mesh);
        ASSERT_FALSE(fill.copies.empty());
        fill.apply(*map);
        EXPECT_EQ(find_lowest(mesh, map), 1.0f);
    }
}

TEST(Gutter, takes_no_value_of_another_island) {
    // One texel between the islands: each side keeps what its own centres hold.
    const Mesh mesh = make_islands(0.6f / kSize);
    auto map = make_map(mesh, {0, 0, 1}, {0, 0, 0});
    const std::vector<float> before = map->floats;
    GutterFill fill = find(test::make_displacement(map), mesh);
    fill.apply(*map);
    for (size_t k = 0; k < before.size(); ++k)
        if (before[k] != 0) EXPECT_EQ(map->floats[k], before[k]);
    EXPECT_NEAR(find_lowest(mesh, map), 1, 1e-6f);
}

TEST(Gutter, leaves_what_is_padded_and_what_is_far_alone) {
    const Mesh mesh = make_islands(0.1f);
    EXPECT_TRUE(find(test::make_displacement(test::make_noise(kSize, kSize, 1, 5)), mesh).copies.empty());
    // Background everywhere but one island, which the mesh does not know.
    auto map = make_map(mesh, {0, 0, 1}, {0, 0, 0});
    const GutterFill fill = find(test::make_displacement(map), mesh);
    EXPECT_LT(fill.copies.size(), 600u);
    for (const GutterFill::Copy& copy : fill.copies) {
        EXPECT_LE(std::abs(int(copy.to_x) - int(copy.from_x)), int(GutterFill::kReach));
        EXPECT_LE(std::abs(int(copy.to_y) - int(copy.from_y)), int(GutterFill::kReach));
    }
    // A painted gutter in a map with background elsewhere.
    for (uint32_t k = 0; k < kSize * kSize; ++k)
        if (map->floats[4 * k + 2] == 0 && (k / kSize) < 62) map->floats[4 * k] = 0.001f * float(k);
    EXPECT_TRUE(find(test::make_displacement(map), mesh).copies.empty());
}

TEST(Gutter, follows_both_ways_of_v_and_all_wraps) {
    for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black}) {
        Mesh mesh = make_islands(0.1f);
        const auto map = make_map(mesh, {0, 0, 1}, {0, 0, 0});
        Displacement displacement = test::make_displacement(map);
        displacement.wrap = wrap, displacement.flip_v = true;
        for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
        // Two units away is the same place where the map repeats.
        if (wrap == WrapMode::repeat || wrap == WrapMode::mirror)
            for (Vec2f& uv : mesh.uvs) uv.x += 2;
        GutterFill fill = find(displacement, mesh);
        fill.apply(*map);
        displacement.space = DisplacementSpace::object;
        const Surface surface = make_surface(mesh, &displacement, {});
        for (uint32_t k = 0; k <= 16; ++k)
            EXPECT_NEAR(evaluate_vertex(surface, 0, {4, {4, 4, 4, 4}}, 16, k).z, 1, 1e-6f);
    }
}

TEST(Gutter, of_a_tile_counts_the_faces_of_that_tile) {
    Mesh mesh = make_islands(0.1f);
    for (size_t k = 4; k < 8; ++k) mesh.uvs[k].x += 1; // the second face lies on tile 1002
    auto map = make_map(make_islands(0.1f), {0, 0, 1}, {0, 0, 0});
    Displacement displacement = test::make_displacement(map);
    displacement.is_udim = true;
    const GutterFill first = find(displacement, mesh);
    displacement.tiles[0].udim = 1002;
    const GutterFill second = find(displacement, mesh);
    displacement.tiles[0].udim = 1003;
    EXPECT_TRUE(find(displacement, mesh).copies.empty());
    ASSERT_FALSE(first.copies.empty());
    ASSERT_FALSE(second.copies.empty());
    for (const GutterFill::Copy& copy : first.copies) EXPECT_LT(copy.from_x, kSize / 2);
    for (const GutterFill::Copy& copy : second.copies) EXPECT_GT(copy.from_x, kSize / 2);
}

/// Quads in random order that share their sides; some faces are left out. The middle is at 0, where
/// some faces have -0.
UvOutlines make_outlines_with_holes() {
    constexpr int kCount = 12;
    std::vector<std::array<int, 2>> cells;
    for (int k = 0; k < kCount * kCount; ++k)
        if (k % 11 != 5) cells.push_back({k % kCount - kCount / 2, k / kCount - kCount / 2});
    std::mt19937 random(11);
    std::shuffle(cells.begin(), cells.end(), random);
    UvOutlines outlines;
    for (const auto& [x, y] : cells) {
        const float zero = random() % 2 == 0 ? 0.0f : -0.0f;
        const auto place = [&](int k) { return k == 0 ? zero : float(k) / 16; };
        const std::array<Vec2f, 4> corners = {Vec2f{place(x), place(y)}, Vec2f{place(x + 1), place(y)},
                                              Vec2f{place(x + 1), place(y + 1)},
                                              Vec2f{place(x), place(y + 1)}};
        const uint32_t first = random(), step = random() % 2 == 0 ? 1 : 3; // both ways round
        for (uint32_t k = 0; k < 4; ++k) outlines.uvs.push_back(corners[(first + step * k) % 4]);
        outlines.end_face();
    }
    return outlines;
}

TEST(Gutter, borders_are_the_edges_of_one_face_only) {
    using Edge = std::array<double, 4>;
    const auto make_edge = [](UvIslands::Point a, UvIslands::Point b) {
        if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) std::swap(a, b);
        return Edge{a.x, a.y, b.x, b.y};
    };
    const UvOutlines outlines = make_outlines_with_holes();
    std::map<Edge, int> counts;
    const auto to_texels = [](const Vec2f& uv) { return UvIslands::Point{uv.x * 64.0, (1 - uv.y) * 64.0}; };
    for (size_t face = 0; face < outlines.face_count(); ++face)
        for (size_t k = 0; k < 4; ++k) {
            const std::span<const Vec2f> uvs = outlines.face(face);
            ++counts[make_edge(to_texels(uvs[k]), to_texels(uvs[(k + 1) % 4]))];
        }
    std::vector<Edge> expected, found;
    for (const auto& [edge, count] : counts)
        if (count == 1) expected.push_back(edge);
    const Displacement displacement = test::make_displacement(test::make_constant(kSize, kSize, {0, 0, 0}));
    UvIslands islands(displacement, displacement.tiles[0]);
    islands.add(outlines);
    for (const auto& [a, b] : islands.borders()) found.push_back(make_edge(a, b));
    std::sort(found.begin(), found.end());
    EXPECT_GT(found.size(), 60u);
    EXPECT_LT(found.size(), counts.size() / 2);
    EXPECT_EQ(found, expected);
}

TEST(Gutter, follows_changes_like_a_fresh_fill) {
    const Mesh mesh = make_islands(0.1f);
    const auto raw = make_map(mesh, {0, 0, 1}, {0, 0, 0});
    auto filled = std::make_shared<Texture>(*raw);
    GutterFill fill = find(test::make_displacement(raw), mesh);
    fill.apply(*filled);
    std::mt19937 random(3);
    for (int round = 0; round < 30; ++round) {
        const uint32_t x = random() % 56, y = random() % 56;
        const float value = round % 3 == 0 ? 0 : float(random() % 100);
        for (const auto& map : {raw, filled})
            for (uint32_t k = 0; k < 64; ++k) map->floats[4 * ((y + k / 8) * kSize + x + k % 8) + 2] = value;
        const TexelRectangle changed{x, y, x + 7, y + 7};
        const TexelRectangle all = fill.follow(*filled, changed);
        EXPECT_LE(all.x0, x);
        EXPECT_GE(all.y1, y + 7);
        Texture fresh = *raw;
        GutterFill again = fill;
        again.apply(fresh);
        ASSERT_EQ(fresh.floats, filled->floats);
    }
}

} // namespace relief
