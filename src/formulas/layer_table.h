// The albedo table of layered materials: a block for each, filled by prepare/material_layers.h. For each
// azimuth, of which most materials have one, rows of kLayerColumns entries, one a roughness; averages of each
// roughness over all azimuths; a row of the fuzz.
#ifndef RELIEF_LAYER_TABLE_H
#define RELIEF_LAYER_TABLE_H
#include "formulas/begin.h"

const uint kLayerColumnCount = 32u;
const float kLayerColumns = 32.0f;

#ifdef __cplusplus
struct LayerTable {
    const Vec2* entries;
};

/// Kernels read the same numbers from memory of their own (vulkan/shaders/ggx_table.glsl).
FN Vec2 read_layer_entry(const LayerTable table, const uint i) { return table.entries[i]; }

/// The same where kernels put a table together from blocks of this one (layer_grid.h).
using GridTable = LayerTable;
FN Vec2 read_grid_entry(const GridTable table, const uint i) { return table.entries[i]; }
#endif

#include "formulas/end.h"
#endif
