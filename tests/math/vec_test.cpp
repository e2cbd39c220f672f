#include "math/vec.h"

#include <gtest/gtest.h>

#include <limits>

#include "math/box.h"

namespace relief {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Vec, multiplies_into_dot_and_cross_products) {
    EXPECT_EQ(dot(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}), 32);
    EXPECT_EQ(cross(Vec3f{1, 0, 0}, Vec3f{0, 1, 0}), (Vec3f{0, 0, 1}));
    EXPECT_EQ(cross(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}), (Vec3f{-3, 6, -3}));
}

TEST(Vec, normalizes_at_any_scale) {
    for (const float scale : {1e-37f, 1e-20f, 1.0f, 1e20f, 1e38f}) {
        const Vec3f unit = normalize(Vec3f{1, -2, 2} * scale);
        EXPECT_NEAR(unit.x, 1.0 / 3, 1e-6) << scale;
        EXPECT_NEAR(unit.y, -2.0 / 3, 1e-6) << scale;
    }
}

TEST(Vec, normalizes_nothing_to_zero) {
    EXPECT_EQ(normalize(Vec3f{0, 0, 0}), Vec3f{});
    EXPECT_EQ(normalize(Vec3f{kInfinity, 0, 0}), Vec3f{});
    EXPECT_EQ(normalize(Vec3f{kNan, kNan, kNan}), Vec3f{});
}

TEST(Vec, tells_whether_it_is_finite) {
    EXPECT_TRUE(is_finite(Vec3f{1, 2, 3}));
    for (const float bad : {kInfinity, -kInfinity, kNan})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f v{1, 2, 3};
            set_component(v, axis, bad);
            EXPECT_FALSE(is_finite(v));
        }
}

TEST(Vec, reads_and_writes_components_by_index) {
    Vec3f v{1, 2, 3};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(get_component(v, axis), float(axis + 1));
        set_component(v, axis, float(-axis));
        EXPECT_EQ(get_component(v, axis), float(-axis));
    }
}

TEST(Box, is_empty_until_it_holds_a_point) {
    Box box;
    EXPECT_TRUE(box.is_empty());
    EXPECT_EQ(box.half_area(), 0);
    box.extend(Box{});
    EXPECT_TRUE(box.is_empty());
    box.extend(Vec3f{1, 2, 3});
    EXPECT_FALSE(box.is_empty());
    EXPECT_TRUE(box.contains(Vec3f{1, 2, 3}));
    EXPECT_FALSE(box.contains(Vec3f{1, 2, 3.001f}));
}

TEST(Box, grows_to_hold_boxes_and_measures_itself) {
    Box box{{0, 0, 0}, {1, 1, 1}};
    box.extend(Box{{2, -1, 0}, {3, 0, 1}});
    EXPECT_EQ(box.lower, (Vec3f{0, -1, 0}));
    EXPECT_EQ(box.upper, (Vec3f{3, 1, 1}));
    EXPECT_EQ(box.half_area(), 3 * 2 + 2 * 1 + 1 * 3);
    EXPECT_EQ(box.center(), (Vec3f{1.5f, 0, 0.5f}));
    EXPECT_TRUE(box.contains(Box{}));
    EXPECT_FALSE(box.contains(Box{{0, 0, 0}, {4, 0, 0}}));
}

} // namespace
} // namespace relief
