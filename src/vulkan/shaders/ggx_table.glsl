// The table of formulas/ggx_table.h in a buffer: shader compilers copy a constant array to each place that indexes it,
// which takes some of them minutes. The table is always bound (vulkan/device/binding_table.cpp).
#ifndef RELIEF_GGX_TABLE_GLSL
#define RELIEF_GGX_TABLE_GLSL

#include "formulas/ggx_table.h"
#include "formulas/layer_table.h"
#include "formulas/layer_grid.h"
#include "vulkan/layout/bindings.h"

layout(constant_id = kVertexNumbersConstant) const uint kHasVertexNumbers = 0;

layout(binding = kBindAlbedos) uniform samplerBuffer ggx_albedo_table;

/// Scale and bias of an entry.
Vec2 read_ggx_table(const uint i) { return texelFetch(ggx_albedo_table, int(i)).xy; }

/// The table of formulas/layer_table.h lies behind it. Here a table is where it begins.
#define GridTable uint
const GridTable kGridTable = kGgxEntryCount;
Vec2 read_grid_entry(const GridTable table, const uint i) { return texelFetch(ggx_albedo_table, int(table + i)).xy; }
#include "formulas/layer_block.h"

/// The same, or the block of one point of a material whose inputs have textures.
struct LayerTable {
    GridTable entries;
    bool is_block; ///< false wherever kHasVertexNumbers is 0
    LayerPlace place;
};

LayerTable make_layer_table(const GridTable entries) {
    LayerTable table;
    table.entries = entries;
    table.is_block = false;
    return table;
}

Vec2 read_layer_entry(const LayerTable table, const uint i) {
    if (kHasVertexNumbers != 0u && table.is_block) return blend_layer_block(table.entries, table.place, i);
    return read_grid_entry(table.entries, i);
}

#endif
