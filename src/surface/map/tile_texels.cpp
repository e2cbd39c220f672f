#include "surface/map/tile_texels.h"

#include <algorithm>
#include <cmath>

#include "surface/map/mip_chain.h"
#include "surface/map/texels.h"
#include "surface/map/wrapped_range.h"

namespace relief {

namespace {

/// Unlike DisplacementMap::image(), also of maps whose bounds are not made yet.
const Texture& get_texture(const DisplacementMap& map, TileIndex tile, uint32_t mip) {
    const DisplacementMap::Tile& own = map.tiles[tile];
    return mip == 0 || !own.mips ? *own.texture : *own.mips->copy(mip).texture;
}

constexpr size_t kLeft = 0, kRight = 1, kAbove = 2, kBelow = 3; ///< entries of TileNeighbours

/// Steps to the tile beside in one axis, if `at` lies outside of [0, size) and there is one.
bool step(const DisplacementMap& map, TileIndex& tile, int64_t& at, int64_t size, size_t before,
          size_t after) {
    if (at >= 0 && at < size) return false;
    const TileIndex next = map.neighbours[tile][at < 0 ? before : after];
    if (next == Surface::kNoTile) return false;
    at += at < 0 ? size : -size;
    tile = next;
    return true;
}

bool is_near_tile(int64_t at, int64_t size) {
    const int64_t margin = scalar::find_tile_margin(int32_t(size));
    return at >= -margin && at < size + margin;
}

/// The two texels of an axis of `other_size` texels that place `index` of `size` texels lies between.
struct Between {
    int64_t low, high;
    float fraction;
};

Between find_between(int64_t index, int64_t size, int64_t other_size) {
    if (size == other_size) return {index, index, 0};
    const float place = scalar::scale_texel_place(int(index), int(size), int(other_size));
    const float low = floor_texel(place);
    return {std::clamp<int64_t>(int64_t(low), 0, other_size - 1),
            std::clamp<int64_t>(int64_t(low) + 1, 0, other_size - 1), place - low};
}

std::array<float, 4> read_between(const Texture& image, const Between& column, const Between& row) {
    if (column.low == column.high && row.low == row.high) return read_channels(image, column.low, row.low);
    return filter_channels(read_channels(image, column.low, row.low),
                           read_channels(image, column.high, row.low),
                           read_channels(image, column.low, row.high),
                           read_channels(image, column.high, row.high), column.fraction, row.fraction);
}

/// The part [first, last] of an axis of `size` texels in one of `other_size`.
std::array<uint32_t, 2> scale_range(const std::array<int64_t, 2>& range, int64_t size, int64_t other_size) {
    const Between low = find_between(range[0], size, other_size),
                  high = find_between(range[1], size, other_size);
    return {uint32_t(low.low), uint32_t(high.high)};
}

/// Adds what a rectangle that lies in one cell of the grid reads of the tile there.
class RangeFinder {
  public:
    RangeFinder(const DisplacementMap& map, uint32_t mip, int64_t width, int64_t height)
        : map_(map), mip_(mip), width_(width), height_(height) {}

    void add(const TilePlace& first, int64_t columns, int64_t rows, TileRanges& ranges) const {
        const int64_t right = first.x + columns - 1, bottom = first.y + rows - 1;
        const WrappedRange x = wrap_range(first.x, right, width_, map_.wrap),
                           y = wrap_range(first.y, bottom, height_, map_.wrap);
        ranges.is_outside_read |= x.is_outside_read || y.is_outside_read || !is_near_tile(first.x, width_) ||
                                  !is_near_tile(right, width_) || !is_near_tile(first.y, height_) ||
                                  !is_near_tile(bottom, height_);
        const Texture& image = get_texture(map_, first.tile, mip_);
        for (int j = 0; j < y.count; ++j)
            for (int i = 0; i < x.count; ++i) {
                const auto across = scale_range(x.parts[size_t(i)], width_, image.width),
                           down = scale_range(y.parts[size_t(j)], height_, image.height);
                ranges.parts.push_back({first.tile, {across[0], down[0], across[1], down[1]}});
            }
    }

  private:
    const DisplacementMap& map_;
    const uint32_t mip_;
    const int64_t width_, height_;
};

int64_t floor_divide(int64_t a, int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

} // namespace

TilePlace find_tile_place(const DisplacementMap& map, TileIndex tile, int64_t x, int64_t y, int64_t width,
                          int64_t height) {
    TilePlace place{tile, x, y, false};
    for (int k = 0; k < scalar::kMostTileSteps; ++k)
        if (!step(map, place.tile, place.x, width, kLeft, kRight) &&
            !step(map, place.tile, place.y, height, kAbove, kBelow))
            break;
    place.is_inside = place.x >= 0 && place.x < width && place.y >= 0 && place.y < height;
    return place;
}

std::array<float, 4> read_place(const DisplacementMap& map, uint32_t mip, const TilePlace& place,
                                int64_t width, int64_t height) {
    const Texture& image = get_texture(map, place.tile, mip);
    return read_between(image, find_between(place.x, width, image.width),
                        find_between(place.y, height, image.height));
}

std::array<float, 4> read_beyond_tile(const DisplacementMap& map, TileIndex tile, uint32_t mip, int64_t x,
                                      int64_t y) {
    const Texture& home = get_texture(map, tile, mip);
    const int64_t width = home.width, height = home.height;
    const TilePlace place = find_tile_place(map, tile, x, y, width, height);
    int64_t column = place.x, row = place.y;
    if (!place.is_inside) {
        const bool is_near = is_near_tile(column, width) && is_near_tile(row, height);
        column = is_near ? wrap_index(column, width, map.wrap) : -1;
        row = is_near ? wrap_index(row, height, map.wrap) : -1;
        if (column < 0 || row < 0) return {map.midlevel.x, map.midlevel.y, map.midlevel.z, 0};
    }
    return read_place(map, mip, {place.tile, column, row, true}, width, height);
}

TileRanges find_tile_ranges(const DisplacementMap& map, TileIndex tile, uint32_t mip,
                            const std::array<int64_t, 2>& columns, const std::array<int64_t, 2>& rows) {
    constexpr int64_t kMostCells = 8; // per axis; for larger rectangles all tiles count
    const Texture& home = get_texture(map, tile, mip);
    const int64_t width = home.width, height = home.height;
    const int64_t left = floor_divide(columns[0], width), right = floor_divide(columns[1], width),
                  top = floor_divide(rows[0], height), bottom = floor_divide(rows[1], height);
    TileRanges ranges;
    if ((right - left + 1) > kMostCells || (bottom - top + 1) > kMostCells) {
        for (size_t k = 0; k < map.tiles.size(); ++k) {
            const Texture& image = get_texture(map, TileIndex(k), mip);
            ranges.parts.push_back({TileIndex(k), {0, 0, image.width - 1, image.height - 1}});
        }
        ranges.is_outside_read = true;
        return ranges;
    }
    const RangeFinder finder(map, mip, width, height);
    for (int64_t j = top; j <= bottom; ++j)
        for (int64_t i = left; i <= right; ++i) {
            const int64_t x0 = std::max(columns[0], i * width),
                          x1 = std::min(columns[1], (i + 1) * width - 1), y0 = std::max(rows[0], j * height),
                          y1 = std::min(rows[1], (j + 1) * height - 1);
            finder.add(find_tile_place(map, tile, x0, y0, width, height), x1 - x0 + 1, y1 - y0 + 1, ranges);
        }
    return ranges;
}

} // namespace relief
