// The block of the albedo table of a material whose layers have textures (prepare/material_layers.h): for
// each azimuth a row for each node of a grid over the numbers with textures, their averages, and rows of the
// fuzz over its roughness. At a point it is a block with one row an azimuth, as layer_table.h has it, between
// the rows around: layer_block.h.
#ifndef RELIEF_LAYER_GRID_H
#define RELIEF_LAYER_GRID_H
#include "formulas/input_numbers.h"

#include "formulas/begin.h"

const uint kMaxLayerAxes = 4u;

/// Without axes and with one row of fuzz: a block with one row.
struct LayerGrid {
    uint axis_count;
    uint place[kMaxLayerAxes]; ///< of the numbers (input_numbers.h)
    uint stride[kMaxLayerAxes];
    float lower[kMaxLayerAxes]; ///< of the first node
    float scale[kMaxLayerAxes]; ///< nodes a unit
    float last[kMaxLayerAxes];  ///< node
    uint row_count;             ///< of each azimuth
    uint azimuth_count;         ///< the rows of one after those of another
    float fuzz_lower, fuzz_scale, fuzz_last;
};

/// Between which rows a point is.
struct LayerPlace {
    uint first_entry; ///< of the block
    uint row_count, azimuth_count;
    uint row; ///< with the least nodes
    uint axis_count;
    uint stride[kMaxLayerAxes];
    float fraction[kMaxLayerAxes];
    uint fuzz_row;
    float fuzz_fraction;
};

FN LayerPlace place_layers(const LayerGrid grid, const uint first_entry, const InputNumbers numbers) {
    LayerPlace place;
    place.first_entry = first_entry;
    place.row_count = grid.row_count;
    place.azimuth_count = grid.azimuth_count;
    place.row = 0u;
    place.axis_count = grid.axis_count;
    for (uint k = 0u; k < kMaxLayerAxes; ++k) {
        place.stride[k] = grid.stride[k];
        place.fraction[k] = 0.0f;
        if (k >= grid.axis_count) continue;
        float y = clamp((numbers.word[grid.place[k]] - grid.lower[k]) * grid.scale[k], 0.0f, grid.last[k]);
        float node = min(floor(y), grid.last[k] - 1.0f);
        place.row += grid.stride[k] * uint(node);
        place.fraction[k] = y - node;
    }
    float y =
        clamp((numbers.word[kInputFuzzRoughness] - grid.fuzz_lower) * grid.fuzz_scale, 0.0f, grid.fuzz_last);
    float node = min(floor(y), max(grid.fuzz_last - 1.0f, 0.0f));
    place.fuzz_row = uint(node);
    place.fuzz_fraction = y - node;
    return place;
}

#include "formulas/end.h"
#endif
