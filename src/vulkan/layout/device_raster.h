// Rasterised first hits: structs shared with kernels. Scalar block layout, members of 4 bytes.
#ifndef RELIEF_DEVICE_RASTER_H
#define RELIEF_DEVICE_RASTER_H
#include "formulas/begin.h"

/// Whole rows of cells of one patch; vertices and cells are numbered row by row. Items are sorted by
/// (instance, patch, row), so that cell indices break ties between hits at one distance.
struct RasterItem {
    uint instance, patch_index;
    uint levels; ///< packed, without LOD bias; 0 for polygons
    uint first_row;
    uint first_vertex, first_cell; ///< in the wave
};

/// Vertices drawn per cell: one rectangle of two triangles.
const uint kRasterVertices = 6u;

/// A wave of items, and the pixels of a batch, in the order of place_pixel, as those of CameraPush.
struct RasterPush {
    Vec3 origin, corner, step_x, step_y; ///< of the camera
    uint x0, y0, width, height;
    uint first_pixel, count;
    uint first_row, row_count; ///< drawn rows of the window
    uint item_count, vertex_count;
};

#include "formulas/end.h"
#endif
