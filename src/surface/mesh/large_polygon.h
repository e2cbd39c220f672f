// Triangles of polygons with many corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace relief {

/// Twice the area of the triangle a b c, positive where it is counter-clockwise.
inline double compute_turn(const Vec2<double>& a, const Vec2<double>& b, const Vec2<double>& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct PolygonCut {
    std::vector<std::array<uint32_t, 3>> triangles; ///< corners of the polygon
    size_t work = 0;                                ///< corners and cells looked at
};

/// Clips ears (Meisters 1975) of a counter-clockwise polygon of at least three corners. Only reflex corners
/// can lie in an ear: a grid finds them, so that polygons of n corners as they are drawn take about n^1.5
/// steps. One that crosses itself may have no ear left: then any corner is taken.
PolygonCut cut_large_polygon(std::span<const Vec2<double>> polygon);

} // namespace relief
