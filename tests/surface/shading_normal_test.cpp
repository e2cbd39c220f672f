#include <gtest/gtest.h>

#include <numbers>

#include "surface/test_scenes.h"

namespace relief {

namespace {

/// Ring of quads around the z axis: a cylinder of radius 1.
Mesh make_cylinder(uint32_t sides) {
    Mesh mesh;
    for (uint32_t k = 0; k < sides; ++k) {
        const float angle = 2 * std::numbers::pi_v<float> * float(k) / float(sides);
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 1});
    }
    for (uint32_t k = 0; k < sides; ++k) {
        const uint32_t a = 2 * k, b = 2 * ((k + 1) % sides);
        const float u0 = float(k) / float(sides), u1 = float(k + 1) / float(sides);
        test::add_face(mesh, {a, b, b + 1, a + 1}, {{u0, 0}, {u1, 0}, {u1, 1}, {u0, 1}});
    }
    return mesh;
}

TEST(ShadingNormal, of_an_undisplaced_map_is_the_smooth_normal) {
    const Displacement displacement = test::make_displacement(test::make_constant(4, 4, {0, 0, 0.3f}));
    const Surface surface = make_surface(make_cylinder(12), &displacement, {});
    for (const float u : {0.0f, 0.25f, 0.5f, 1.0f}) {
        const float angle = 2 * std::numbers::pi_v<float> * (2 + u) / 12;
        const Vec3f normal = compute_shading_normal(surface, 2, 5, u, 0.4f);
        EXPECT_NEAR(length(normal - Vec3f{std::cos(angle), std::sin(angle), 0}), 0, 5e-3f);
    }
}

TEST(ShadingNormal, is_continuous_across_patches) {
    auto texture = test::make_constant(256, 64, {0, 0, 0});
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            float* texel = &texture->floats[4 * (256 * y + x)];
            const float a = 2 * std::numbers::pi_v<float> * float(x) / 256;
            texel[0] = 0.1f * std::sin(9 * a), texel[1] = 0.05f * std::cos(5 * a),
            texel[2] = 0.1f * std::sin(7 * a);
        }
    Displacement displacement = test::make_displacement(texture);
    displacement.wrap = WrapMode::repeat;
    for (const auto space : {DisplacementSpace::tangent, DisplacementSpace::object}) {
        displacement.space = space;
        const Surface surface = make_surface(make_cylinder(32), &displacement, {});
        for (uint32_t patch = 0; patch + 1 < 32; ++patch)
            EXPECT_LT(length(compute_shading_normal(surface, patch, 4, 1, 0.5f) -
                             compute_shading_normal(surface, patch + 1, 4, 0, 0.5f)),
                      0.03f);
    }
}

TEST(ShadingNormal, of_a_slope_is_that_of_the_displaced_plane) {
    auto texture = test::make_constant(64, 64, {0, 0, 0});
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) texture->floats[4 * (64 * y + x) + 2] = 2 * (float(x) + 0.5f) / 64;
    const Displacement displacement = test::make_displacement(texture);
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    const Vec3f normal = compute_shading_normal(surface, 0, 4, 0.5f, 0.5f);
    EXPECT_NEAR(length(normal - normalize(Vec3f{-2, 0, 1})), 0, 1e-4f);
}

TEST(ShadingNormal, of_plain_meshes_is_the_files_on_the_side_of_the_winding) {
    Mesh mesh = test::make_plane();
    EXPECT_EQ(compute_shading_normal(make_surface(mesh, nullptr, {}), 0, 0, 0.5f, 0.5f), Vec3f{});
    mesh.normals = {normalize(Vec3f{1, 0, -1}), {0, 0, -1}};
    mesh.normal_indices = {0, 1, 1, 0};
    const Surface surface = make_surface(mesh, nullptr, {});
    EXPECT_NEAR(length(compute_shading_normal(surface, 0, 0, 0, 0.5f) - normalize(Vec3f{-1, 0, 1})), 0,
                1e-3f);
    EXPECT_NEAR(compute_shading_normal(surface, 0, 0, 1, 0.5f).z, 1, 1e-5f);
}

} // namespace

} // namespace relief
