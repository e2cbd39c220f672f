#include "samples/bake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/half.h"
#include "samples/lathe.h"
#include "samples/outline.h"
#include "samples/plates.h"
#include "samples/profile.h"

namespace relief::samples {
namespace {

TEST(FloatToHalf, inverts_half_to_float_for_every_finite_half) {
    for (uint32_t bits = 0; bits < 0x10000; ++bits) {
        if ((bits & 0x7c00u) == 0x7c00u) continue;
        ASSERT_EQ(float_to_half(half_to_float(uint16_t(bits))), bits);
    }
}

TEST(FloatToHalf, rounds_to_the_nearest_and_ties_to_even) {
    EXPECT_EQ(float_to_half(1 + 0x1p-11f), float_to_half(1));
    EXPECT_EQ(float_to_half(1 + 0x1.8p-11f), float_to_half(1 + 0x1p-10f));
    EXPECT_EQ(float_to_half(1 + 0x3p-11f), float_to_half(1 + 0x1p-9f));
    EXPECT_EQ(half_to_float(float_to_half(1e9f)), 65504);
}

TEST(BakeMaps, put_row_0_at_v_1_and_average_colours) {
    const Maps maps = bake_maps("ramp", 8, Texels::floats, [](Vec2f uv) {
        return MapSample{{uv.x, uv.y, 0}, {uv.x, uv.y, 0.5f}};
    });
    EXPECT_FLOAT_EQ(maps.displacement->floats[0], 0.5f / 8);
    EXPECT_FLOAT_EQ(maps.displacement->floats[1], 7.5f / 8);
    EXPECT_EQ(maps.color->width, 4u);
    EXPECT_FLOAT_EQ(half_to_float(maps.color->halves[0]), 1.0f / 8);
}

TEST(ProfileCurve, goes_through_its_points_and_clamps) {
    const ProfileCurve curve({{0, 0}, {1, 2}, {3, 1}}, ProfileCurve::Ends::free);
    EXPECT_EQ(curve.at(0), (Vec2f{0, 0}));
    EXPECT_EQ(curve.at(0.5f), (Vec2f{1, 2}));
    EXPECT_EQ(curve.at(2), (Vec2f{3, 1}));
}

TEST(Outline, distance_is_positive_inside) {
    std::vector<Vec2f> circle;
    for (int i = 0; i < 12; ++i)
        circle.push_back({std::cos(0.5236f * float(i)), std::sin(0.5236f * float(i))});
    const Outline outline(circle, Outline::Kind::closed);
    EXPECT_NEAR(outline.find({0.5f, 0}).distance, 0.5f, 0.02f);
    EXPECT_NEAR(outline.find({0, -1.5f}).distance, -0.5f, 0.02f);
    EXPECT_LT(outline.find({0.9f, 0}).inward.x, -0.99f);
}

TEST(PlateField, repeats_after_the_tile) {
    const PlateField field({6, 4, 0.8f, 0.01f, 3});
    for (const Vec2f& p : {Vec2f{0.1f, 0.2f}, Vec2f{0.93f, 0.51f}, Vec2f{0.5f, 0.99f}}) {
        const PlateHit a = field.find(p), b = field.find({p.x + 1, p.y - 1});
        EXPECT_EQ(a.seed, b.seed);
        EXPECT_NEAR(a.distance, b.distance, 1e-4f);
    }
}

TEST(LatheBody, atlas_and_mesh_agree_on_every_vertex) {
    LatheShape shape;
    shape.profile = {{0, -1}, {0.7f, -0.7f}, {1, 0}, {0.7f, 0.7f}, {0, 1}};
    shape.cap_cells = 4;
    shape.rows = 5;
    const LatheBody body(shape);
    const Mesh mesh = body.make_mesh("ball", [](const Vec3f& p) { return p; });
    ASSERT_EQ(int(mesh.face_sizes.size()), body.patch_count());
    for (size_t i = 0; i < mesh.position_indices.size(); ++i) {
        const Vec3f a = mesh.positions[mesh.position_indices[i]];
        const Vec3f b = body.point_at_uv(mesh.uvs[mesh.uv_indices[i]]).position;
        ASSERT_LT(length(a - b), 2e-4f) << "corner " << i;
    }
}

} // namespace
} // namespace relief::samples
