// Texels beyond the border of a UDIM tile: those of the tile beside it, where the mesh continues there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/map/texel_range.h"
#include "surface/patch/surface.h"

namespace relief {

/// A place in texels of one tile's grid, which continues beyond its borders, and the tile that it is in.
struct TilePlace {
    TileIndex tile = 0;
    int64_t x = 0, y = 0;   ///< counted from that tile, still in texels of the first one's grid
    bool is_inside = false; ///< no tile has the place where this is false: `tile` is the last one on the way
};

/// The tile that texel (x, y) of the grid of `tile` lies in; the grid has width x height texels per tile.
TilePlace find_tile_place(const DisplacementMap& map, TileIndex tile, int64_t x, int64_t y, int64_t width,
                          int64_t height);

/// The texel at a place inside of a tile; the grid has width x height texels per tile.
std::array<float, 4> read_place(const DisplacementMap& map, uint32_t mip, const TilePlace& place,
                                int64_t width, int64_t height);

/// Texel (x, y) of the grid of copy `mip` of a tile, outside of it; for maps with `neighbours`. Tiles of
/// another size are read bilinearly. Where no tile is, the last one on the way continues by the map's wrap
/// mode for find_tile_margin() texels; beyond them the result is the midlevel.
std::array<float, 4> read_beyond_tile(const DisplacementMap& map, TileIndex tile, uint32_t mip, int64_t x,
                                      int64_t y);

/// Texels of one tile that a rectangle of another one's grid reads.
struct TileRange {
    TileIndex tile;
    TexelRectangle texels;
};
struct TileRanges {
    std::vector<TileRange> parts;
    bool is_outside_read = false; ///< some places are not displaced
};

/// Lists all texels that read_beyond_tile() and reads inside may read for the places [columns] x [rows]
/// (inclusive). The list may hold more.
TileRanges find_tile_ranges(const DisplacementMap& map, TileIndex tile, uint32_t mip,
                            const std::array<int64_t, 2>& columns, const std::array<int64_t, 2>& rows);

/// Whether all of [columns] x [rows] (inclusive) lies in the image.
inline bool is_within_image(const Texture& image, const std::array<int64_t, 2>& columns,
                            const std::array<int64_t, 2>& rows) {
    return columns[0] >= 0 && rows[0] >= 0 && columns[1] < int64_t(image.width) &&
           rows[1] < int64_t(image.height);
}

} // namespace relief
