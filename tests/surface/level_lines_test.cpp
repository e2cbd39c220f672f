#include "surface/patch/level_lines.h"

#include <cstring>

#include <gtest/gtest.h>

#include "support/targets.h"
#include "surface/test_scenes.h"

namespace relief {
namespace {

void expect_lines_of_definition(const Mesh& mesh, const Displacement& displacement) {
    const Surface surface = make_surface(mesh, &displacement, {});
    test::check_on_every_target([&] {
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const PatchSamples samples(surface, patch, PatchSamples::Filtering::none);
            const LevelLines many = evaluate_level_lines(surface, patch, samples);
            const LevelLines one_by_one = evaluate_level_lines(samples);
            ASSERT_EQ(std::memcmp(&many, &one_by_one, sizeof many), 0) << patch;
        }
    });
}

TEST(LevelLines, are_the_same_many_points_at_once_and_one_by_one) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::black}) {
            Displacement displacement = test::make_displacement(test::make_noise(90, 70, 0.2f, 2));
            displacement.space = space, displacement.wrap = wrap;
            displacement.midlevel = {0.1f, 0, -0.2f};
            expect_lines_of_definition(test::make_random_grid(6, 5, 0.4f, 9), displacement);
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(LevelLines, follow_smooth_bases_and_need_no_map) {
    Displacement displacement = test::make_displacement(test::make_noise(64, 64, 0.1f, 4));
    Mesh mesh = test::make_random_grid(4, 4, 0.3f, 2);
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    expect_lines_of_definition(mesh, displacement);
    displacement.is_udim = true;
    displacement.tiles[0].udim = 1002;
    expect_lines_of_definition(test::make_random_grid(4, 4, 0.3f, 2), displacement);
}

} // namespace
} // namespace relief
