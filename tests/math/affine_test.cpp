#include "math/affine.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace relief {
namespace {

class RandomMaps {
  public:
    explicit RandomMaps(uint32_t seed) : random_(seed) {}

    float number(float size) { return std::uniform_real_distribution<float>(-size, size)(random_); }
    Vec3f point(float size) {
        const float x = number(size), y = number(size), z = number(size);
        return {x, y, z};
    }
    Affine map(float size) {
        Affine m;
        for (Vec3f& row : m.rows) row = point(size);
        m.translation = point(size);
        return m;
    }

  private:
    std::mt19937 random_;
};

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance) { EXPECT_LE(length(a - b), tolerance); }

TEST(Affine, undoes_itself_with_its_inverse) {
    RandomMaps random(1);
    for (int k = 0; k < 1000; ++k) {
        const Affine m = random.map(10);
        if (std::fabs(compute_determinant(m)) < 10) continue;
        const std::optional<Affine> inverse = invert(m);
        ASSERT_TRUE(inverse.has_value());
        const Vec3f p = random.point(10);
        expect_near(transform_point(*inverse, transform_point(m, p)), p, 0.02f);
    }
}

TEST(Affine, has_no_inverse_when_singular_or_not_finite) {
    EXPECT_FALSE(invert(make_scale({1, 0, 1})).has_value());
    EXPECT_FALSE(invert(make_scale({0, 0, 0})).has_value());
    EXPECT_FALSE(invert(make_scale({1, std::numeric_limits<float>::quiet_NaN(), 1})).has_value());
    EXPECT_FALSE(invert(make_translation({0, std::numeric_limits<float>::infinity(), 0})).has_value());
    Affine dependent;
    dependent.rows = {Vec3f{1, 2, 3}, Vec3f{2, 4, 6}, Vec3f{0, 0, 1}};
    EXPECT_FALSE(invert(dependent).has_value());
}

TEST(Affine, has_an_inverse_at_tiny_and_huge_scale) {
    for (const float scale : {1e-10f, 1e10f}) {
        const std::optional<Affine> inverse = invert(make_scale({scale, scale, scale}));
        ASSERT_TRUE(inverse.has_value());
        EXPECT_NEAR(inverse->rows[0].x * scale, 1, 1e-6);
    }
}

TEST(Affine, composes_from_right_to_left) {
    RandomMaps random(2);
    for (int k = 0; k < 100; ++k) {
        const Affine outer = random.map(3), inner = random.map(3);
        const Vec3f p = random.point(3);
        expect_near(transform_point(compose(outer, inner), p),
                    transform_point(outer, transform_point(inner, p)), 1e-4f);
    }
    const Affine moved_then_scaled = compose(make_scale({2, 2, 2}), make_translation({1, 0, 0}));
    EXPECT_EQ(transform_point(moved_then_scaled, {0, 0, 0}), (Vec3f{2, 0, 0}));
}

TEST(Affine, bounds_every_transformed_point_of_a_box) {
    RandomMaps random(3);
    for (int k = 0; k < 20000; ++k) {
        const float scale = k % 3 == 0 ? 1e-6f : k % 3 == 1 ? 1.0f : 1e6f;
        const Affine m = random.map(scale);
        Box box;
        box.extend(random.point(scale));
        if (k % 5 != 0) box.extend(random.point(scale));
        const Box bounds = transform_box(m, box);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3f p{corner & 1 ? box.lower.x : box.upper.x, corner & 2 ? box.lower.y : box.upper.y,
                          corner & 4 ? box.lower.z : box.upper.z};
            ASSERT_TRUE(bounds.contains(transform_point(m, p)));
        }
        ASSERT_TRUE(bounds.contains(transform_point(m, box.lower * 0.5f + box.upper * 0.5f)));
    }
}

TEST(Affine, bounds_a_box_tightly_and_keeps_an_empty_one_empty) {
    const Box bounds = transform_box(make_scale({2, -1, 1}), Box{{0, 1, 2}, {1, 3, 4}});
    expect_near(bounds.lower, {0, -3, 2}, 1e-5f);
    expect_near(bounds.upper, {2, -1, 4}, 1e-5f);
    EXPECT_TRUE(transform_box(make_translation({1, 1, 1}), Box{}).is_empty());
}

TEST(Affine, keeps_normals_perpendicular_to_transformed_tangents) {
    RandomMaps random(4);
    for (int k = 0; k < 500; ++k) {
        const Affine m = random.map(1);
        const std::optional<Affine> inverse = invert(m);
        if (!inverse || std::fabs(compute_determinant(m)) < 0.05f) continue;
        const Vec3f u = random.point(1), v = random.point(1);
        const Vec3f normal = normalize(transform_normal(*inverse, cross(u, v)));
        EXPECT_NEAR(dot(normal, normalize(transform_vector(m, u))), 0, 1e-3);
        EXPECT_NEAR(dot(normal, normalize(transform_vector(m, v))), 0, 1e-3);
    }
}

TEST(Affine, rotates_about_x_then_y_then_z_and_exactly_by_right_angles) {
    EXPECT_EQ(transform_vector(make_rotation_degrees({90, 0, 0}), {0, 1, 0}), (Vec3f{0, 0, 1}));
    EXPECT_EQ(transform_vector(make_rotation_degrees({0, 90, 0}), {0, 0, 1}), (Vec3f{1, 0, 0}));
    EXPECT_EQ(transform_vector(make_rotation_degrees({0, 0, 90}), {1, 0, 0}), (Vec3f{0, 1, 0}));
    EXPECT_EQ(transform_vector(make_rotation_degrees({90, 90, 0}), {0, 1, 0}), (Vec3f{1, 0, 0}));
    const float half = std::sqrt(0.5f);
    expect_near(transform_vector(make_rotation_degrees({0, 0, 45}), {1, 0, 0}), {half, half, 0}, 1e-6f);
}

TEST(Affine, has_a_negative_determinant_when_it_mirrors) {
    EXPECT_EQ(compute_determinant(make_scale({-1, 2, 3})), -6);
    EXPECT_NEAR(compute_determinant(make_rotation_degrees({10, 20, 30})), 1, 1e-6);
}

} // namespace
} // namespace relief
