#include "surface/patch/level_lines.h"

#include <cstring>

#include <gtest/gtest.h>

#include "relief/half.h"
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

TEST(LevelLines, follow_smooth_maps_of_floats_and_halves) {
    for (const bool has_halves : {false, true})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black}) {
            const std::shared_ptr<Texture> noise = test::make_noise(40, 30, 0.2f, 5);
            for (const float value : noise->floats)
                if (has_halves) noise->halves.push_back(float_to_half(value));
            if (has_halves) noise->floats.clear();
            Displacement displacement = test::make_displacement(noise);
            displacement.filter = MapFilter::bspline, displacement.wrap = wrap;
            Mesh mesh = test::make_random_grid(4, 4, 0.4f, 3);
            for (Vec2f& uv : mesh.uvs) uv = {uv.x * 3.7f - 1.2f, uv.y * 2.9f - 0.8f};
            expect_lines_of_definition(mesh, displacement);
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(LevelLines, cross_borders_of_tiles) {
    Displacement displacement = test::make_displacement(test::make_noise(32, 32, 0.1f, 4));
    displacement.is_udim = true;
    displacement.tiles.push_back(displacement.tiles[0]);
    displacement.tiles[1].udim = 1002;
    Mesh mesh = test::make_random_grid(4, 4, 0.3f, 2);
    for (Vec2f& uv : mesh.uvs) uv.x *= 2;
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    expect_lines_of_definition(mesh, displacement);
    mesh.subdivision = {};
    expect_lines_of_definition(mesh, displacement);
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
