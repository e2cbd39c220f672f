#include <gtest/gtest.h>

#include "surface/test_scenes.h"

namespace relief {

namespace {

Vec3f random_unit(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return normalize(Vec3f{normal(random), normal(random), normal(random)});
}

TEST(Frame, comes_back_within_the_packing_precision) {
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round) {
        const Vec3f n = random_unit(random), other = random_unit(random);
        if (length(cross(n, other)) < 0.01f) continue;
        const Vec3f t = normalize(cross(n, other));
        const float handedness = round % 2 == 0 ? 1.0f : -1.0f;
        const Frame frame = unpack_frame(pack_frame(n, t, handedness));
        ASSERT_LT(length(frame.n - n), 1e-4f);
        ASSERT_LT(length(frame.t - t), 4e-4f);
        ASSERT_LT(length(frame.b - cross(n, t) * handedness), 4e-4f);
        ASSERT_NEAR(dot(frame.n, frame.t), 0, 1e-6f);
        ASSERT_NEAR(length(frame.t), 1, 1e-6f);
    }
}

TEST(Frame, along_the_axes_is_exact) {
    const Vec3f axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    for (int n = 0; n < 6; ++n)
        for (int t = 0; t < 6; ++t) {
            if (n % 3 == t % 3) continue;
            for (const float handedness : {1.0f, -1.0f}) {
                const Frame frame = unpack_frame(pack_frame(axes[n], axes[t], handedness));
                EXPECT_EQ(frame.n, axes[n]);
                EXPECT_EQ(frame.t, axes[t]);
                EXPECT_EQ(frame.b, cross(axes[n], axes[t]) * handedness);
            }
        }
}

TEST(Frame, of_a_plane_is_that_of_its_uvs) {
    const Mesh mesh = test::make_plane();
    const Displacement displacement = test::make_displacement(test::make_constant(4, 4, {0, 0, 0}));
    const Surface surface = make_surface(mesh, &displacement, {});
    for (const PackedFrame& packed : surface.frames) {
        const Frame frame = unpack_frame(packed);
        EXPECT_EQ(frame.t, (Vec3f{1, 0, 0}));
        EXPECT_EQ(frame.b, (Vec3f{0, 1, 0}));
        EXPECT_EQ(frame.n, (Vec3f{0, 0, 1}));
    }
}

TEST(Frame, of_mirrored_uvs_has_its_bitangent_along_growing_v) {
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv.x = 1 - uv.x;
    const Displacement displacement = test::make_displacement(test::make_constant(4, 4, {0, 0, 0}));
    const Surface surface = make_surface(mesh, &displacement, {});
    const Frame frame = unpack_frame(surface.frames[0]);
    EXPECT_EQ(frame.t, (Vec3f{-1, 0, 0}));
    EXPECT_EQ(frame.b, (Vec3f{0, 1, 0}));
    EXPECT_EQ(frame.n, (Vec3f{0, 0, 1}));
}

} // namespace

} // namespace relief
