#include "surface/map/displacement_change.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "base/udim.h"
#include "scene/tile_use.h"
#include "surface/map/displacement_map.h"
#include "surface/map/texels.h"
#include "surface/map/tile_texels.h"
#include "surface/map/wrapped_range.h"

namespace relief {

namespace {

constexpr uint32_t kStepBlock = 8; // texels per side
/// Texels of a footprint whose own steps are measured, not those of blocks.
constexpr int64_t kMostSteps = 1024;

/// The displacement by a texel, apart from what is the same for all texels.
std::array<float, 3> find_vector(const DisplacementMap& map, const std::array<float, 3>& texel) {
    std::array<float, 3> vector;
    for (size_t k = 0; k < 3; ++k)
        vector[k] = map.matrix[k].x * texel[0] + map.matrix[k].y * texel[1] + map.matrix[k].z * texel[2];
    return vector;
}

float find_square(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/// Largest step between neighbours in a rectangle.
float measure_steps(const DisplacementMap& map, const Texture& texture, const TexelRectangle& texels) {
    std::vector<std::array<float, 3>> above(texels.x1 - texels.x0 + 1); // the row before
    float largest = 0;
    for (uint32_t y = texels.y0; y <= texels.y1; ++y)
        for (uint32_t x = texels.x0; x <= texels.x1; ++x) {
            const std::array<float, 3> here = find_vector(map, read_texel(texture, x, y));
            std::array<float, 3>& known = above[x - texels.x0];
            if (y > texels.y0) largest = std::max(largest, find_square(here, known));
            if (x > texels.x0) largest = std::max(largest, find_square(here, (&known)[-1]));
            known = here;
        }
    return std::sqrt(largest);
}

uint64_t count_texels(const DisplacementMap& map, TileIndex tile) {
    const Texture& texture = *map.tiles[tile].texture;
    return uint64_t(texture.width) * texture.height;
}

} // namespace

TileChoice choose_tile(const DisplacementMap& map, const std::array<Vec2f, 4>& uvs) {
    const TileSpan span = find_tile_span(uvs);
    TileChoice choice{Surface::kNoTile, {float(span.middle_column), float(span.middle_row)}};
    // At the same count of texels the tile of the middle comes first, then the first one of the map.
    std::tuple<uint64_t, bool, int> best{};
    const auto consider = [&](double column, double row) {
        const std::optional<int> udim = find_udim(column, row);
        const TileIndex tile = udim ? map.find_tile(*udim) : Surface::kNoTile;
        if (tile == Surface::kNoTile) return;
        const bool is_middle = column == span.middle_column && row == span.middle_row;
        const std::tuple here(count_texels(map, tile), is_middle, -int(tile));
        if (here > best) best = here, choice = {tile, {float(column), float(row)}};
    };
    consider(span.middle_column, span.middle_row);
    if (span.is_one()) return choice;
    const TileSpan clipped = span.clip();
    for (double row = clipped.row0; row <= clipped.row1; ++row)
        for (double column = clipped.column0; column <= clipped.column1; ++column) consider(column, row);
    return choice;
}

DisplacementChange::DisplacementChange(const DisplacementMap& map, bool is_udim)
    : map_(map), is_udim_(is_udim), longest_(find_longest_displacement(map)), blocks_(map.tiles.size()) {
    for (size_t tile = 0; tile < map.tiles.size(); ++tile) {
        const Texture& texture = *map.tiles[tile].texture;
        Blocks& blocks = blocks_[tile];
        blocks.width = (texture.width + kStepBlock - 1) / kStepBlock,
        blocks.height = (texture.height + kStepBlock - 1) / kStepBlock;
        blocks.steps = std::vector<std::atomic<float>>(size_t(blocks.width) * blocks.height);
        for (std::atomic<float>& step : blocks.steps) step.store(-1, std::memory_order_relaxed);
    }
}

/// Largest step between the texels of a block, the first ones of the next blocks included.
float DisplacementChange::find_step(size_t tile, uint32_t x, uint32_t y) const {
    std::atomic<float>& known = blocks_[tile].steps[size_t(y) * blocks_[tile].width + x];
    float largest = known.load(std::memory_order_relaxed);
    if (largest >= 0) return largest;
    const Texture& texture = *map_.tiles[tile].texture;
    // With the first texels of the next blocks.
    const TexelRectangle block{x * kStepBlock, y * kStepBlock,
                               std::min((x + 1) * kStepBlock, texture.width - 1),
                               std::min((y + 1) * kStepBlock, texture.height - 1)};
    largest = measure_steps(map_, texture, block);
    known.store(largest, std::memory_order_relaxed);
    return largest;
}

double DisplacementChange::find_change(const std::array<Vec2f, 4>& uvs, const Vec2<double>& error,
                                       double enough) const {
    const TileChoice tile = is_udim_ ? choose_tile(map_, uvs) : TileChoice{};
    if (tile.index >= map_.tiles.size() || (error.x == 0 && error.y == 0)) return 0;
    const Texture& texture = *map_.tiles[tile.index].texture;
    double u0 = uvs[0].x, u1 = u0, v0 = uvs[0].y, v1 = v0;
    for (const Vec2f& uv : uvs) {
        u0 = std::min(u0, double(uv.x)), u1 = std::max(u1, double(uv.x));
        v0 = std::min(v0, double(uv.y)), v1 = std::max(v1, double(uv.y));
    }
    u0 -= tile.offset.x, u1 -= tile.offset.x, v0 -= tile.offset.y, v1 -= tile.offset.y;
    if (!map_.flip_v) std::tie(v0, v1) = std::pair(1 - v1, 1 - v0);
    const double reach = map_.is_smooth ? 2 : 1; // texels that a filter reads on each side
    const auto first = [&](double low, double off, double size) {
        return int64_t(std::floor((low - off) * size - 0.5 - reach));
    };
    const auto last = [&](double high, double off, double size) {
        return int64_t(std::ceil((high + off) * size - 0.5 + reach));
    };
    const double texels = error.x * texture.width + error.y * texture.height;
    const std::array<int64_t, 2> read_columns = {first(u0, error.x, texture.width),
                                                 last(u1, error.x, texture.width)},
                                 read_rows = {first(v0, error.y, texture.height),
                                              last(v1, error.y, texture.height)};
    if (!map_.neighbours.empty() && !is_within_image(texture, read_columns, read_rows))
        return std::min(2 * longest_, find_step_across_tiles(tile.index, read_columns, read_rows) * texels);
    const WrappedRange columns = wrap_range(first(u0, error.x, texture.width),
                                            last(u1, error.x, texture.width), texture.width, map_.wrap),
                       rows = wrap_range(first(v0, error.y, texture.height),
                                         last(v1, error.y, texture.height), texture.height, map_.wrap);
    // Beyond a border the map goes on with other values.
    if (columns.count != 1 || rows.count != 1 || columns.is_outside_read || rows.is_outside_read)
        return 2 * longest_ * std::min(1.0, texels);
    const auto [x0, x1] = columns.parts[0];
    const auto [y0, y1] = rows.parts[0];
    const TexelRectangle read{uint32_t(x0), uint32_t(y0), uint32_t(x1), uint32_t(y1)};
    const double by_blocks = double(find_step_by_blocks(tile.index, read)) * texels;
    if (by_blocks <= enough || (x1 - x0 + 1) * (y1 - y0 + 1) > kMostSteps)
        return std::min(2 * longest_, by_blocks);
    return std::min(2 * longest_, double(measure_steps(map_, texture, read)) * texels);
}

/// The same as measure_steps() for a rectangle of a tile's grid that reaches into other tiles, or beyond
/// them.
double DisplacementChange::find_step_across_tiles(TileIndex tile, const std::array<int64_t, 2>& columns,
                                                  const std::array<int64_t, 2>& rows) const {
    const Texture& texture = *map_.tiles[tile].texture;
    if (columns[1] - columns[0] > kMostSteps || rows[1] - rows[0] > kMostSteps ||
        (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1) > 4 * kMostSteps)
        return 2 * longest_;
    const auto read = [&](int64_t x, int64_t y) {
        const std::array<float, 4> texel = is_within_image(texture, {x, x}, {y, y})
                                               ? read_channels(texture, x, y)
                                               : read_beyond_tile(map_, tile, 0, x, y);
        return find_vector(map_, {texel[0], texel[1], texel[2]});
    };
    std::vector<std::array<float, 3>> above(size_t(columns[1] - columns[0] + 1));
    float largest = 0;
    for (int64_t y = rows[0]; y <= rows[1]; ++y)
        for (int64_t x = columns[0]; x <= columns[1]; ++x) {
            const std::array<float, 3> here = read(x, y);
            std::array<float, 3>& known = above[size_t(x - columns[0])];
            if (y > rows[0]) largest = std::max(largest, find_square(here, known));
            if (x > columns[0]) largest = std::max(largest, find_square(here, (&known)[-1]));
            known = here;
        }
    return std::sqrt(double(largest));
}

/// No less than the largest step between neighbours in a rectangle.
float DisplacementChange::find_step_by_blocks(size_t tile, const TexelRectangle& texels) const {
    float step = 0;
    for (uint32_t y = texels.y0 / kStepBlock; y <= texels.y1 / kStepBlock; ++y)
        for (uint32_t x = texels.x0 / kStepBlock; x <= texels.x1 / kStepBlock; ++x)
            step = std::max(step, find_step(tile, x, y));
    return step;
}

} // namespace relief
