// Polygons of many corners: the triangles cover them, in about linear work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface/mesh/large_polygon.h"

namespace relief {
namespace {

using Polygon = std::vector<Vec2<double>>;

double compute_area(const Polygon& p, uint32_t a, uint32_t b, uint32_t c) {
    return ((p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[b].y - p[a].y) * (p[c].x - p[a].x)) / 2;
}

double compute_area(const Polygon& p) {
    double sum = 0;
    for (size_t k = 0; k < p.size(); ++k) {
        const Vec2<double>&a = p[k], &b = p[(k + 1) % p.size()];
        sum += (a.x * b.y - a.y * b.x) / 2;
    }
    return sum;
}

/// All triangles are counter-clockwise and together as large as the polygon: none overlap.
PolygonCut expect_covered(const Polygon& polygon) {
    PolygonCut cut = cut_large_polygon(polygon);
    EXPECT_EQ(cut.triangles.size(), polygon.size() - 2);
    double area = 0;
    for (const auto& [a, b, c] : cut.triangles) {
        EXPECT_GE(compute_area(polygon, a, b, c), 0);
        area += compute_area(polygon, a, b, c);
    }
    EXPECT_NEAR(area, compute_area(polygon), 1e-9 * compute_area(polygon));
    return cut;
}

Polygon make_star(int corners) {
    Polygon polygon;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners, radius = k % 2 ? 1 : 0.7;
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return polygon;
}

/// A strip wound into a spiral, as mazes are.
Polygon make_spiral(int steps) {
    Polygon polygon;
    for (int k = 0; k < steps; ++k)
        polygon.push_back({(1 + 0.02 * k) * std::cos(0.3 * k), (1 + 0.02 * k) * std::sin(0.3 * k)});
    for (int k = steps - 1; k >= 0; --k)
        polygon.push_back({(0.8 + 0.02 * k) * std::cos(0.3 * k), (0.8 + 0.02 * k) * std::sin(0.3 * k)});
    if (compute_area(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

TEST(LargePolygon, is_covered_by_its_triangles) {
    expect_covered(make_star(1000));
    expect_covered(make_spiral(2000));
    Polygon square; // corners on a line
    for (int k = 0; k < 100; ++k) square.push_back({double(k), 0});
    for (int k = 0; k < 100; ++k) square.push_back({100, double(k)});
    for (int k = 100; k > 0; --k) square.push_back({double(k), 100});
    for (int k = 100; k > 0; --k) square.push_back({0, double(k)});
    EXPECT_NEAR(compute_area(square), 10000, 1e-6);
    expect_covered(square);
}

TEST(LargePolygon, takes_far_less_than_quadratic_work) {
    for (const auto& make : {make_star, make_spiral}) {
        const double small = double(cut_large_polygon(make(4000)).work),
                     large = double(cut_large_polygon(make(64000)).work);
        EXPECT_LT(large, 160 * small) << "sixteen times the corners";
    }
}

TEST(LargePolygon, that_crosses_itself_still_ends) {
    Polygon polygon;
    for (int k = 0; k < 999; ++k) polygon.push_back({std::cos(2.0 * k), std::sin(2.0 * k)});
    EXPECT_EQ(cut_large_polygon(polygon).triangles.size(), 997u);
}

} // namespace
} // namespace relief
