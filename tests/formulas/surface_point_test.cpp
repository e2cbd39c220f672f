#include "formulas/surface_point.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace relief {
namespace {

using scalar::CornerWeights;
using scalar::leave_edges;

constexpr float kError = 1e-5f;

struct EdgeTriangle {
    Vec3f b, c; ///< corners; the other one lies at the origin

    Vec3f place(const CornerWeights& weights) const { return b * weights.b + c * weights.c; }
    float double_area() const { return length(cross(b, c)); }
    Vec3f move(const CornerWeights& weights) const {
        return leave_edges(place(weights), kError, weights, b, c, double_area());
    }
    /// Least distance of a point within it from its edges.
    float find_distance_to_edges(const Vec3f& p) const {
        const auto find_distance = [&](const Vec3f& from, const Vec3f& along) {
            return length(cross(along, p - from)) / length(along);
        };
        return std::min({find_distance({}, b), find_distance({}, c), find_distance(b, c - b)});
    }
};

TEST(SurfacePoint, leaves_the_edges_of_its_triangle) {
    for (const float height : {1.5f, 0.3f, 0.03f})
        for (int i = 0; i <= 200; ++i)
            for (int j = 0; i + j <= 200; ++j) {
                const EdgeTriangle triangle{{2, 0, 0}, {0.5f, height, 0}};
                const CornerWeights weights{float(i) / 200, float(j) / 200};
                const Vec3f moved = triangle.move(weights);
                EXPECT_GT(triangle.find_distance_to_edges(moved), 8 * kError)
                    << height << ' ' << i << ' ' << j;
                EXPECT_LT(length(moved - triangle.place(weights)), 0.1f) << height << ' ' << i << ' ' << j;
            }
}

/// All of it lies near its edges: no more than a sixteenth of the way.
TEST(SurfacePoint, stays_in_a_small_triangle) {
    const EdgeTriangle triangle{{2e-5f, 0, 0}, {0, 2e-5f, 0}};
    const CornerWeights weights{0.5f, 0};
    const Vec3f moved = triangle.move(weights);
    EXPECT_GT(triangle.find_distance_to_edges(moved), 1e-6f);
    EXPECT_LT(length(moved - triangle.place(weights)), 2e-6f);
}

TEST(SurfacePoint, stays_where_no_edge_is_near) {
    const EdgeTriangle triangle{{2, 0, 0}, {0.5f, 1.5f, 0}};
    const CornerWeights weights{0.3f, 0.3f};
    EXPECT_EQ(triangle.move(weights), triangle.place(weights));
}

TEST(SurfacePoint, stays_in_triangles_without_area) {
    const Vec3f p{1, 2, 3};
    EXPECT_EQ(leave_edges(p, kError, {0, 0.5f}, {}, {}, 0), p);
    EXPECT_EQ(leave_edges(p, kError, {0, 0.5f}, {1, 0, 0}, {1, 0, 0}, 0), p);
}

} // namespace
} // namespace relief
