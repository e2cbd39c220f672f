#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "surface/test_scenes.h"

namespace relief {

namespace {

struct Side {
    uint32_t patch;
    int edge;
};

std::map<std::pair<uint32_t, uint32_t>, std::vector<Side>> find_sides(const Surface& surface) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<Side>> sides;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (int k = 0; k < 4; ++k) {
            const Quad quad = surface.quads[patch];
            const uint32_t a = surface.dominant(quad.vertex[k]),
                           b = surface.dominant(quad.vertex[(k + 1) & 3]);
            sides[std::minmax(a, b)].push_back({patch, k});
        }
    return sides;
}

TEST(EvaluateVertex, gives_both_sides_of_an_edge_the_same_bits) {
    std::mt19937 random(7);
    int shared_count = 0;
    for (uint32_t round = 0; round < 12; ++round) {
        Mesh mesh = test::make_random_grid(4, 3, 0.25f * float(round % 4), round);
        Displacement displacement = test::make_displacement(test::make_noise(32, 16, 0.4f, round));
        displacement.space = round % 3 == 0 ? DisplacementSpace::object : DisplacementSpace::tangent;
        displacement.wrap = round % 2 == 0 ? WrapMode::repeat : WrapMode::clamp;
        displacement.frame = round % 5 < 2 ? FrameKind::dpdu : FrameKind::mikk;
        displacement.lengths = FrameLengths(round / 2 % 2);
        const Surface surface = make_surface(mesh, &displacement, {});
        const auto sides = find_sides(surface);
        std::vector<PatchLevels> levels(surface.patch_count());
        for (const auto& [key, owners] : sides) {
            const uint8_t level = uint8_t(random() % 5);
            for (const Side& side : owners) {
                levels[side.patch].edge[side.edge] = level;
                levels[side.patch].patch = std::max(levels[side.patch].patch, level);
            }
        }
        for (PatchLevels& patch : levels) patch.patch = uint8_t(patch.patch + random() % 2);
        for (uint32_t bias = 0; bias < 4; ++bias)
            for (const auto& [key, owners] : sides) {
                if (owners.size() != 2) continue;
                ++shared_count;
                auto a = test::evaluate_edge(surface, owners[0].patch, levels[owners[0].patch].biased(bias),
                                             owners[0].edge);
                auto b = test::evaluate_edge(surface, owners[1].patch, levels[owners[1].patch].biased(bias),
                                             owners[1].edge);
                std::reverse(b.begin(), b.end());
                ASSERT_EQ(test::drop_repeats(a), test::drop_repeats(b))
                    << "round " << round << " bias " << bias;
            }
    }
    EXPECT_GT(shared_count, 100);
}

TEST(EvaluateVertex, is_a_subset_one_level_down) {
    const Mesh mesh = test::make_random_grid(2, 2, 0.5f, 3);
    const Displacement displacement = test::make_displacement(test::make_noise(32, 32, 0.4f, 3));
    const Surface surface = make_surface(mesh, &displacement, {});
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (uint32_t j = 0; j <= 8; ++j)
            for (uint32_t i = 0; i <= 8; ++i)
                ASSERT_EQ(evaluate_vertex(surface, patch, {3, {3, 3, 3, 3}}, i, j),
                          evaluate_vertex(surface, patch, {4, {4, 4, 4, 4}}, 2 * i, 2 * j));
}

TEST(EvaluateVertex, of_a_plane_adds_the_map_in_its_frame) {
    const Displacement displacement = test::make_displacement(test::make_constant(3, 3, {0.25f, -0.5f, 2}));
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    const PatchLevels levels{2, {2, 2, 2, 2}};
    for (uint32_t j = 0; j <= 4; ++j)
        for (uint32_t i = 0; i <= 4; ++i)
            EXPECT_EQ(evaluate_vertex(surface, 0, levels, i, j),
                      (Vec3f{float(i) / 4 + 0.25f, float(j) / 4 - 0.5f, 2}));
}

TEST(EvaluateVertex, moves_samples_onto_a_coarser_edge) {
    const Displacement displacement = test::make_displacement(test::make_noise(8, 8, 0.4f, 4));
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    const PatchLevels levels{2, {1, 2, 2, 0}};
    EXPECT_EQ(evaluate_vertex(surface, 0, levels, 1, 0), evaluate_vertex(surface, 0, levels, 2, 0));
    EXPECT_EQ(evaluate_vertex(surface, 0, levels, 3, 0), evaluate_vertex(surface, 0, levels, 4, 0));
    EXPECT_EQ(evaluate_vertex(surface, 0, levels, 0, 1), evaluate_vertex(surface, 0, levels, 0, 0));
    EXPECT_EQ(evaluate_vertex(surface, 0, levels, 0, 2), evaluate_vertex(surface, 0, levels, 0, 4));
}

} // namespace

} // namespace relief
