// The block with one row an azimuth that a point has in the grid of layer_grid.h.
#ifndef RELIEF_LAYER_BLOCK_H
#define RELIEF_LAYER_BLOCK_H
#include "formulas/layer_grid.h"
#include "formulas/layer_table.h"

#include "formulas/begin.h"

/// Between the rows around a point; `first`: the entry of row 0, `stride` from row to row.
FN Vec2 blend_layer_rows(const GridTable table, const LayerPlace place, const uint first, const uint stride) {
    Vec2 sum = {0.0f, 0.0f};
    for (uint tap = 0u; tap < (1u << place.axis_count); ++tap) {
        uint row = place.row;
        float weight = 1.0f;
        for (uint k = 0u; k < place.axis_count; ++k) {
            bool is_upper = ((tap >> k) & 1u) != 0u;
            row += is_upper ? place.stride[k] : 0u;
            weight = weight * (is_upper ? place.fraction[k] : 1.0f - place.fraction[k]);
        }
        if (weight > 0.0f) sum = sum + read_grid_entry(table, first + row * stride) * weight;
    }
    return sum;
}

/// Place of the average in the block that a point has; the fuzz follows.
FN uint find_block_average(const uint azimuth_count) { return azimuth_count * kLayerColumnCount; }

/// Entry `i` of the block that a point has.
FN Vec2 blend_layer_block(const GridTable table, const LayerPlace place, const uint i) {
    uint average = find_block_average(place.azimuth_count);
    uint averages = place.first_entry + place.row_count * average;
    if (i < average) {
        uint azimuth = i / kLayerColumnCount;
        uint first = place.first_entry + azimuth * place.row_count * kLayerColumnCount;
        return blend_layer_rows(table, place, first + i - azimuth * kLayerColumnCount, kLayerColumnCount);
    }
    if (i == average) return blend_layer_rows(table, place, averages, 1u);
    uint fuzz = averages + place.row_count + place.fuzz_row * kLayerColumnCount + i - average - 1u;
    Vec2 lower = read_grid_entry(table, fuzz);
    if (!(place.fuzz_fraction > 0.0f)) return lower;
    return lower * (1.0f - place.fuzz_fraction) +
           read_grid_entry(table, fuzz + kLayerColumnCount) * place.fuzz_fraction;
}

#include "formulas/end.h"
#endif
