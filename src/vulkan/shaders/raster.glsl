// Rasterised first hits, made exact (docs/decisions/hybrid-by-exact-raster.md): a wave of items and vertices by row.
#ifndef RELIEF_RASTER_GLSL
#define RELIEF_RASTER_GLSL

#include "vulkan/shaders/scene.glsl"
#include "vulkan/layout/device_raster.h"

layout(scalar, push_constant) uniform Push { RasterPush push; };
layout(scalar, set = 0, binding = kBindRasterItems) readonly buffer Items { RasterItem items[]; };

/// Cells per row; one less than vertices per row.
uint count_columns(const RasterItem item) { return 1u << packed_patch_level(item.levels); }

/// The item that a cell of the wave belongs to.
uint find_item(const uint number) {
    uint low = 0u;
    uint high = push.item_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (items[middle].first_cell <= number)
            low = middle;
        else
            high = middle - 1u;
    }
    return low;
}

/// A cell of an item, with rows relative to the item.
struct RasterCell {
    RasterItem item;
    uint column, row;
};

RasterCell make_cell(const uint item_index, const uint number) {
    RasterCell cell;
    cell.item = items[item_index];
    uint place = number - cell.item.first_cell;
    cell.column = place % count_columns(cell.item);
    cell.row = place / count_columns(cell.item);
    return cell;
}

#ifdef READS_RASTER_VERTICES
layout(scalar, set = 0, binding = kBindRasterVertices) readonly buffer Vertices { vec3 raster_vertices[]; };

/// Corners in the order 00 10 11 01.
struct CellCorners {
    vec3 p00, p10, p11, p01;
};

CellCorners load_cell(const RasterCell cell) {
    uint stride = count_columns(cell.item) + 1u;
    uint first = cell.item.first_vertex + cell.row * stride + cell.column;
    return CellCorners(raster_vertices[first], raster_vertices[first + 1u], raster_vertices[first + stride + 1u],
                       raster_vertices[first + stride]);
}
#endif

#endif
