#include "prepare/scene_maps.h"

#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "surface/map/displacement_map.h"
#include "surface/mesh/tile_links.h"

namespace relief {

namespace {

std::vector<uint32_t> list_meshes(const Scene& scene, uint32_t displacement) {
    std::set<uint32_t> meshes;
    for (const Object& object : scene.objects)
        if (object.displacement == displacement) meshes.insert(object.mesh);
    return {meshes.begin(), meshes.end()};
}

/// Makes the outlines of some meshes, where they are not there yet.
std::vector<const UvOutlines*> list_outlines(std::span<const uint32_t> meshes, MeshLimits& limits) {
    limits.make_outlines(meshes);
    std::vector<const UvOutlines*> list;
    for (const uint32_t mesh : meshes) list.push_back(&limits.outlines(mesh));
    return list;
}

/// Coefficients in place of texels, once for each form of an image. Keeps the images alive.
class SplineCache {
  public:
    std::shared_ptr<const Texture> get_or_make(const std::shared_ptr<const Texture>& texels,
                                               const SplineForm& form) {
        if (!texels || form.keeps_texels()) return texels;
        Entry& entry = entries_[{texels.get(), form}];
        if (!entry.coefficients) entry = {texels, make_spline(texels, form)};
        return entry.coefficients;
    }

  private:
    struct Entry {
        std::shared_ptr<const Texture> texels, coefficients;
    };
    std::map<std::pair<const Texture*, SplineForm>, Entry> entries_;
};

/// A tile of a displacement whose gutter is to be found.
struct WantedGutter {
    uint32_t displacement;
    size_t tile;
    std::vector<const UvOutlines*> meshes;
};

/// Lists the tiles that are not as before and may have a background.
std::vector<WantedGutter> list_gutters(const Scene& scene, const SameParts& same, MeshLimits& limits) {
    std::vector<WantedGutter> wanted;
    for (uint32_t k = 0; k < scene.displacements.size(); ++k) {
        const Displacement& displacement = scene.displacements[k];
        if (!displacement.dilate || same.images[k]) continue;
        const std::vector<uint32_t> meshes = list_meshes(scene, k);
        for (size_t tile = 0; tile < displacement.tiles.size() && !meshes.empty(); ++tile)
            if (may_have_background(*displacement.tiles[tile].texture))
                wanted.push_back({k, tile, list_outlines(meshes, limits)});
    }
    return wanted;
}

/// Finds gutters per displacement and tile, of several tiles at once.
std::vector<std::vector<GutterFill>> find_gutters(const Scene& scene, const SameParts& same,
                                                  MeshLimits& limits) {
    std::vector<std::vector<GutterFill>> gutters(scene.displacements.size());
    for (uint32_t k = 0; k < scene.displacements.size(); ++k)
        gutters[k].resize(scene.displacements[k].tiles.size());
    const std::vector<WantedGutter> wanted = list_gutters(scene, same, limits);
    parallel_for("gutters", wanted.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const auto& [number, tile, meshes] = wanted[k];
            const Displacement& displacement = scene.displacements[number];
            gutters[number][tile] = find_gutter(displacement, displacement.tiles[tile], meshes);
        }
    });
    return gutters;
}

/// Prepares the map of a tile with its gutter; the tile's texture becomes the one that surfaces read.
void prepare_map(const Displacement& displacement, MapTile& tile, GutterFill gutter,
                 std::span<const uint32_t> meshes, MeshLimits& limits, SplineCache& splines,
                 EditableScene& prepared) {
    const void* source = tile.texture.get();
    if (!gutter.copies.empty()) {
        auto filled = std::make_shared<Texture>(*tile.texture);
        gutter.apply(*filled);
        tile.texture = std::move(filled);
    }
    std::shared_ptr<MipChain> mips;
    if (displacement.filter == MapFilter::mip && !meshes.empty()) {
        const TexelRectangle all{0, 0, tile.texture->width - 1, tile.texture->height - 1};
        if (!find_texel_range(*tile.texture, all)) refuse_bad_texel(*tile.texture, all);
        OutsideTexels outside;
        if (displacement.dilate)
            outside = find_outside_texels(displacement, tile, list_outlines(meshes, limits));
        mips = std::make_shared<MipChain>(*tile.texture, std::move(outside), displacement.wrap);
    }
    PreparedMap map;
    map.displacement = displacement.name, map.udim = tile.udim;
    map.texture = tile.texture, map.gutter = std::move(gutter), map.mips = mips;
    map.form = make_spline_form(displacement);
    map.is_flipped = displacement.flip_v;
    map.source = source;
    if (!map.form.keeps_texels() && !meshes.empty() && !displacement.is_udim)
        tile.texture = map.coefficients = splines.get_or_make(tile.texture, map.form);
    prepared.scene->maps.push_back(std::move(map));
    prepared.mips.push_back(std::move(mips));
}

/// Coefficients of all tiles of a map, which depend on the tiles beside; `maps`: of its tiles, in order.
void make_coefficients_of_tiles(const Scene& scene, std::span<const uint32_t> meshes,
                                Displacement& displacement, std::span<PreparedMap> maps,
                                SplineCache& splines) {
    std::vector<TileNeighbours> links;
    for (const uint32_t mesh : meshes)
        join_tile_links(find_tile_links(scene.meshes[mesh], displacement.tiles, displacement.flip_v), links);
    const bool is_linked = has_links(links);
    const DisplacementMap texels = make_texel_map(displacement, links);
    for (size_t k = 0; k < maps.size(); ++k) {
        PreparedMap& map = maps[k];
        const TileSurroundings surroundings{texels, TileIndex(k)};
        map.coefficients = is_linked ? make_spline(map.texture, map.form, &surroundings)
                                     : splines.get_or_make(map.texture, map.form);
        map.has_neighbours = is_linked;
        if (is_linked) map.neighbours = links[k];
        displacement.tiles[k].texture = map.coefficients;
    }
}

/// The number of a displacement's first tile among all.
size_t find_first_map(const std::vector<Displacement>& displacements, size_t displacement) {
    size_t first = 0;
    for (size_t k = 0; k < displacement; ++k) first += displacements[k].tiles.size();
    return first;
}

/// What was made of the images before.
void take_over(const SceneParts& before, size_t displacement, std::vector<MapTile>& tiles,
               EditableScene& prepared) {
    const size_t first = find_first_map(before.displacements, displacement);
    for (size_t k = 0; k < tiles.size(); ++k) {
        const PreparedMap& map = before.prepared.scene->maps[first + k];
        tiles[k].texture = map.coefficients ? map.coefficients : map.texture;
        prepared.scene->maps.push_back(map);
        prepared.mips.push_back(before.prepared.mips[first + k]);
    }
}

} // namespace

void prepare_textures(std::vector<Material>& materials) {
    SplineCache splines;
    for (Material& material : materials) {
        for (InputTexture& placed : material.textures) {
            SplineForm form = make_spline_form(placed.filter);
            form.wrap = placed.is_udim ? WrapMode::clamp : placed.wrap;
            for (MapTile& tile : placed.tiles) tile.texture = splines.get_or_make(tile.texture, form);
            if (is_smooth(placed.filter)) placed.filter = MapFilter::bspline;
        }
    }
}

void prepare_maps(Scene& scene, const SameParts& same, const SceneParts* before, MeshLimits& limits,
                  EditableScene& prepared) {
    SplineCache splines;
    std::vector<std::vector<GutterFill>> gutters = find_gutters(scene, same, limits);
    for (uint32_t k = 0; k < scene.displacements.size(); ++k) {
        Displacement& displacement = scene.displacements[k];
        const std::vector<uint32_t> meshes = list_meshes(scene, k);
        if (same.images[k])
            take_over(*before, same.old_displacements[k], displacement.tiles, prepared);
        else
            for (size_t tile = 0; tile < displacement.tiles.size(); ++tile)
                prepare_map(displacement, displacement.tiles[tile], std::move(gutters[k][tile]), meshes,
                            limits, splines, prepared);
        if (displacement.is_udim && !same.images[k] && !meshes.empty() &&
            !make_spline_form(displacement).keeps_texels()) {
            std::vector<PreparedMap>& maps = prepared.scene->maps;
            const size_t count = displacement.tiles.size();
            make_coefficients_of_tiles(scene, meshes, displacement,
                                       std::span(maps).subspan(maps.size() - count, count), splines);
        }
        // What the surfaces get are coefficients now.
        if (is_smooth(displacement.filter) && !meshes.empty())
            displacement.filter = MapFilter::bspline, displacement.dequantize = false;
    }
}

void share_mips(const Scene& scene, const SurfaceNumbers& surfaces, PreparedScene& prepared) {
    std::vector<size_t> first_map(scene.displacements.size(), 0);
    for (size_t k = 1; k < first_map.size(); ++k)
        first_map[k] = first_map[k - 1] + scene.displacements[k - 1].tiles.size();
    for (const auto& [key, surface] : surfaces) {
        const uint32_t displacement = std::get<1>(key);
        if (displacement == kNoIndex) continue;
        std::vector<DisplacementMap::Tile>& tiles = prepared.surfaces[surface].map.tiles;
        for (size_t k = 0; k < tiles.size(); ++k)
            tiles[k].mips = prepared.maps[first_map[displacement] + k].mips;
    }
}

} // namespace relief
