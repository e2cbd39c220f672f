// The table of formulas/ggx_table.h in a buffer: shader compilers copy a constant array to each place that indexes it,
// which takes some of them minutes. The table is always bound (vulkan/device/binding_table.cpp).
#ifndef RELIEF_GGX_TABLE_GLSL
#define RELIEF_GGX_TABLE_GLSL

#include "formulas/ggx_table.h"
#include "formulas/layer_table.h"
#include "vulkan/layout/bindings.h"

layout(binding = kBindAlbedos) uniform samplerBuffer ggx_albedo_table;

/// Scale and bias of an entry.
Vec2 read_ggx_table(uint i) { return texelFetch(ggx_albedo_table, int(i)).xy; }

/// The table of formulas/layer_table.h lies behind it. A table is where it begins.
#define LayerTable uint
const LayerTable kLayerTable = kGgxEntryCount;
Vec2 read_layer_entry(LayerTable table, uint i) { return texelFetch(ggx_albedo_table, int(table + i)).xy; }

#endif
