// Indices of the control points of a bicubic patch.
#ifndef RELIEF_CONTROL_POINTS_H
#define RELIEF_CONTROL_POINTS_H
#include "formulas/begin.h"

/// Control points of a patch other than its corners.
const uint kInnerControlCount = 12u;

/// 0..3 are the corners, 4 + 2 k and 5 + 2 k those of edge k from corner k to the next one, 12 + k the inner
/// one beside corner k. `column` counts along u, `row` along v, 0..3.
FN uint find_control_point(const uint column, const uint row) {
    uint rows = column == 0u ? 0x3AB0u : column == 1u ? 0x9FC4u : column == 2u ? 0x8ED5u : 0x2761u;
    return (rows >> (4u * row)) & 15u;
}

#include "formulas/end.h"
#endif
