#include "surface/map/displacement_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "scene/coordinate_limit.h"
#include "scene/displacement_conventions.h"
#include "surface/map/mip_chain.h"
#include "surface/map/spline_coefficients.h"

namespace relief {

namespace {

[[noreturn]] void throw_bad_map(const Displacement& displacement, std::string message, std::string hint) {
    throw Error(ErrorKind::bad_input,
                {std::move(message), fmt::format("displacement '{}'", displacement.name), std::move(hint)});
}

std::array<Vec3f, 3> make_matrix(const Displacement& displacement, const Affine& object_from_world) {
    if (!is_finite(displacement.midlevel) || !is_finite(displacement.scale))
        throw_bad_map(displacement, "midlevel or scale is not finite", "give plain numbers");
    std::array<Vec3f, 3> matrix{};
    if (displacement.type == DisplacementType::height) {
        matrix[2].x = displacement.scale.x;
        return matrix;
    }
    const std::array<uint8_t, 3>& axis = displacement.axes.axis;
    if ((1 << axis[0] | 1 << axis[1] | 1 << axis[2]) != 7 || axis[0] > 2 || axis[1] > 2 || axis[2] > 2)
        throw_bad_map(displacement, "axes are not a permutation", "name each of the three axes once");
    for (int channel = 0; channel < 3; ++channel)
        set_component(matrix[axis[channel]], channel,
                      float(displacement.axes.sign[channel]) * get_component(displacement.scale, channel));
    if (displacement.space != DisplacementSpace::world) return matrix;
    std::array<Vec3f, 3> turned;
    for (int row = 0; row < 3; ++row) {
        const Vec3f& m = object_from_world.rows[row];
        turned[row] = matrix[0] * m.x + matrix[1] * m.y + matrix[2] * m.z;
    }
    return turned;
}

ChannelRange find_whole_range(const DisplacementMap& map, const DisplacementMap::Tile& tile) {
    return tile.pyramid->query(0, 0, int64_t(tile.texture->width) - 1, int64_t(tile.texture->height) - 1,
                               WrapMode::clamp, {map.midlevel.x, map.midlevel.y, map.midlevel.z});
}

/// Along an axis of the frame, of which no coordinate is longer than the longest.
double find_row_reach(const DisplacementMap& map, const Vec3f& row, const ChannelRange& range) {
    double reach = 0;
    for (int c = 0; c < 3; ++c) {
        const double middle = get_component(map.midlevel, c);
        const double low = double(range.low[c]) - middle, high = double(range.high[c]) - middle;
        reach += std::fmax(std::fabs(low), std::fabs(high)) * std::fabs(get_component(row, c));
    }
    return reach * double(map.longest_axis);
}

} // namespace

TileIndex DisplacementMap::find_tile(int udim) const {
    const auto found = std::ranges::lower_bound(udims, udim, {}, &std::pair<int, TileIndex>::first);
    return found != udims.end() && found->first == udim ? found->second : Surface::kNoTile;
}

DisplacementMap::ImageView DisplacementMap::image(TileIndex tile, uint32_t mip) const {
    const Tile& own = tiles[tile];
    if (mip == 0 || !own.mips) return {*own.texture, *own.pyramid};
    const MipChain::Copy& copy = own.mips->copy(mip);
    return {*copy.texture, *copy.pyramid};
}

std::shared_ptr<const BoundsPyramid>
PyramidCache::get_or_build(const std::shared_ptr<const Texture>& texture) {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = entries_.find(texture.get());
        if (found != entries_.end()) return found->second.pyramid;
    }
    // Not under the lock: the build runs a parallel loop, whose worker might come here for another surface.
    auto pyramid = std::make_shared<const BoundsPyramid>(BoundsPyramid::build(*texture));
    const std::lock_guard<std::mutex> lock(mutex_);
    return entries_.try_emplace(texture.get(), Entry{texture, std::move(pyramid)}).first->second.pyramid;
}

void PyramidCache::keep(const std::shared_ptr<const Texture>& texture,
                        const std::shared_ptr<const BoundsPyramid>& pyramid) {
    const std::lock_guard<std::mutex> lock(mutex_);
    entries_.try_emplace(texture.get(), Entry{texture, pyramid});
}

void check_reach(const std::string& name, const DisplacementMap& map, const std::string& file,
                 const ChannelRange& range) {
    for (const Vec3f& row : map.matrix) {
        const double reach = find_row_reach(map, row, range);
        if (!(reach <= kLargestCoordinate)) refuse_reach(name, file, reach);
    }
}

void check_reach(const std::string& name, const DisplacementMap& map) {
    for (const DisplacementMap::Tile& tile : map.tiles)
        check_reach(name, map, tile.texture->file, find_whole_range(map, tile));
}

double find_longest_displacement(const DisplacementMap& map) {
    double longest = 0;
    for (const DisplacementMap::Tile& tile : map.tiles) {
        const ChannelRange range = find_whole_range(map, tile);
        double sum = 0;
        for (const Vec3f& row : map.matrix) sum += find_row_reach(map, row, range);
        longest = std::fmax(longest, sum);
    }
    return std::numbers::sqrt3 * longest; // an axis is at most so much longer than its longest coordinate
}

bool has_links(const std::vector<TileNeighbours>& neighbours) {
    return std::ranges::any_of(neighbours, [](const TileNeighbours& beside) {
        return std::ranges::any_of(beside, [](TileIndex tile) { return tile != Surface::kNoTile; });
    });
}

DisplacementMap make_texel_map(const Displacement& displacement, std::vector<TileNeighbours> neighbours) {
    DisplacementMap map;
    for (const MapTile& tile : displacement.tiles)
        map.tiles.push_back({tile.udim, tile.texture, nullptr, nullptr});
    map.neighbours = std::move(neighbours);
    map.midlevel = displacement.midlevel;
    map.wrap = displacement.wrap;
    map.flip_v = displacement.flip_v;
    return map;
}

DisplacementMap make_displacement_map(const Displacement& displacement, const Affine& object_from_world,
                                      PyramidCache& pyramids, std::vector<TileNeighbours> neighbours) {
    DisplacementMap map;
    map.matrix = make_matrix(displacement, object_from_world);
    map.midlevel = displacement.midlevel;
    map.wrap = displacement.wrap;
    map.flip_v = displacement.flip_v;
    map.is_filtered = displacement.filter == MapFilter::mip;
    map.has_autobump = displacement.autobump;
    map.is_smooth = is_smooth(displacement.filter);
    map.is_tangent =
        displacement.type == DisplacementType::height || displacement.space == DisplacementSpace::tangent;
    if (displacement.type == DisplacementType::height) map.midlevel = {displacement.midlevel.x, 0, 0};
    if (displacement.tiles.empty()) throw_bad_map(displacement, "has no map", "name an image file");
    if (displacement.tiles.size() > size_t(kMaxMapTiles))
        throw_bad_map(displacement, fmt::format("has {} tiles", displacement.tiles.size()),
                      fmt::format("at most {} are possible", kMaxMapTiles));
    map.neighbours = std::move(neighbours);
    const DisplacementMap texels = make_texel_map(displacement, map.neighbours);
    for (size_t k = 0; k < displacement.tiles.size(); ++k) {
        const MapTile& tile = displacement.tiles[k];
        if (!tile.texture)
            throw_bad_map(displacement, fmt::format("tile {} has no image", tile.udim), "load it first");
        const TileSurroundings surroundings{texels, TileIndex(k)};
        const std::shared_ptr<const Texture> texture =
            make_spline(tile.texture, make_spline_form(displacement),
                        has_links(map.neighbours) ? &surroundings : nullptr);
        map.tiles.push_back({tile.udim, texture, pyramids.get_or_build(texture), nullptr});
    }
    for (size_t k = 0; k < map.tiles.size(); ++k) map.udims.emplace_back(map.tiles[k].udim, TileIndex(k));
    std::ranges::sort(map.udims);
    check_reach(displacement.name, map);
    return map;
}

} // namespace relief
