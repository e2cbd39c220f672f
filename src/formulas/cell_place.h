// The cell that a position on a patch lies in, and the position within it.
#ifndef RELIEF_CELL_PLACE_H
#define RELIEF_CELL_PLACE_H
#include "formulas/surface_point.h"

#include "formulas/begin.h"

/// Position on a patch of side * side cells. `is_upper`: on the second triangle of cell (i, j).
struct CellPlace {
    float u, v;
    uint i, j;
    bool is_upper;
};

/// Cell that holds (u, v); on a triangle (u, v) is folded into v <= u.
FN CellPlace locate_cell(const bool is_triangle, const uint side, const float u, const float v) {
    bool is_folded = is_triangle && v > u;
    CellPlace place;
    place.u = select(is_folded, v, u);
    place.v = select(is_folded, u, v);
    float x = clamp(place.u, 0.0f, 1.0f) * float(side);
    float y = clamp(place.v, 0.0f, 1.0f) * float(side);
    uint column = uint(x);
    uint row = uint(y);
    place.i = select(column < side, column, side - 1u);
    place.j = select(row < side, row, side - 1u);
    place.is_upper = !is_triangle && y - float(place.j) > x - float(place.i);
    return place;
}

FN CornerWeights weigh_corners(const CellPlace place, const float side) {
    Vec2 at = {place.u, place.v};
    Vec2 cell = {float(place.i), float(place.j)};
    return weigh_cell_corners(at, cell, place.is_upper, side);
}

/// Area of one micro-triangle in the patch's (u, v).
FN float triangle_uv_area(const bool is_triangle, const float side) {
    return is_triangle ? 1.0f : 0.5f / (side * side);
}

#include "formulas/end.h"
#endif
