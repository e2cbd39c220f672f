#include "scene/tile_use.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/udim.h"
#include "relief/inspect.h"

namespace relief {

namespace {

constexpr double kUvRounding = 1e-5; ///< that files with few digits bring with them
constexpr double kMostSquares = 64;  ///< per axis: a face across more of them is no picture of any

/// First and last square of an axis between two coordinates. Beyond a million there is no tile, and further
/// out a number plus 1 would be the same number, so that loops over squares would not end.
std::pair<double, double> find_squares(double low, double high, double middle) {
    const auto clip = [](double square) { return std::clamp(square, -1e6, 1e6); };
    const double first = std::floor(low + kUvRounding), last = std::ceil(high - kUvRounding) - 1;
    return first <= last ? std::pair(clip(first), clip(last)) : std::pair(clip(middle), clip(middle));
}

std::string count_faces(size_t count, const char* verb, const char* plural_verb) {
    return count == 1 ? fmt::format("1 face {}", verb) : fmt::format("{} faces {}", count, plural_verb);
}

} // namespace

TileSpan find_tile_span(std::span<const Vec2f> uvs) {
    double u = 0, v = 0;
    Vec2f low = uvs[0], high = uvs[0];
    for (const Vec2f& uv : uvs) {
        u += double(uv.x), v += double(uv.y);
        low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
        high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
    }
    TileSpan span{};
    span.middle_column = std::floor(u / double(uvs.size())),
    span.middle_row = std::floor(v / double(uvs.size()));
    std::tie(span.column0, span.column1) = find_squares(low.x, high.x, span.middle_column);
    std::tie(span.row0, span.row1) = find_squares(low.y, high.y, span.middle_row);
    return span;
}

TileUse find_tile_use(const Mesh& mesh) {
    TileUse use;
    std::vector<Vec2f> uvs;
    size_t first = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); first += mesh.face_sizes[face++]) {
        uvs.clear();
        for (size_t k = first; k < first + mesh.face_sizes[face] && k < mesh.uv_indices.size(); ++k)
            if (mesh.uv_indices[k] < mesh.uvs.size()) uvs.push_back(mesh.uvs[mesh.uv_indices[k]]);
        if (uvs.empty()) continue;
        const TileSpan span = find_tile_span(uvs);
        if (!span.is_one() && use.crossing++ == 0) use.first_crossing = face;
        bool has_tile = false;
        const double last_column = std::min(span.column1, span.column0 + kMostSquares),
                     last_row = std::min(span.row1, span.row0 + kMostSquares);
        for (double row = span.row0; row <= last_row; ++row)
            for (double column = span.column0; column <= last_column; ++column)
                if (const std::optional<int> udim = find_udim(column, row))
                    use.tiles.insert(*udim), has_tile = true;
        if (!has_tile && use.outside++ == 0) use.first_outside = face;
    }
    return use;
}

std::set<int> find_missing_tiles(const TileUse& use, const Displacement& map) {
    std::set<int> missing = use.tiles;
    for (const MapTile& tile : map.tiles) missing.erase(tile.udim);
    return missing;
}

std::vector<std::string> describe_misplaced_faces(const TileUse& use) {
    std::vector<std::string> texts;
    if (use.crossing > 0)
        texts.push_back(
            fmt::format("{} across two tiles or more, the first is face {}: each sample reads the "
                        "tile that it is in; cut the faces along the borders of tiles, or move "
                        "their uvs into one",
                        count_faces(use.crossing, "lies", "lie"), use.first_crossing));
    if (use.outside > 0)
        texts.push_back(
            fmt::format("{} outside of all tiles (u from 0 to 10, v from 0), the first is face {}: "
                        "no map can displace them; move their uvs into a tile",
                        count_faces(use.outside, "lies", "lie"), use.first_outside));
    return texts;
}

std::vector<std::string> find_tile_warnings(const Mesh& mesh, const Displacement& map) {
    std::vector<std::string> warnings;
    if (!map.is_udim) return warnings;
    const TileUse use = find_tile_use(mesh);
    if (const std::set<int> missing = find_missing_tiles(use, map); !missing.empty())
        warnings.push_back(
            fmt::format("displacement '{}' has no file for tile(s) {} of mesh '{}', which is not "
                        "displaced there: export the missing ones, or look at their names",
                        map.name, fmt::join(missing, ", "), mesh.name));
    for (const std::string& text : describe_misplaced_faces(use))
        warnings.push_back(fmt::format("displacement '{}' on mesh '{}': {}", map.name, mesh.name, text));
    return warnings;
}

std::vector<std::string> find_tile_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    for (const Object& object : scene.objects) {
        if (object.displacement == kNoIndex || !pairs.insert({object.mesh, object.displacement}).second)
            continue;
        for (std::string& warning :
             find_tile_warnings(scene.meshes[object.mesh], scene.displacements[object.displacement]))
            warnings.push_back(std::move(warning));
    }
    return warnings;
}

} // namespace relief
