#include "scene/tile_use.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/udim.h"
#include "relief/inspect.h"

namespace relief {

namespace {

/// First and last square of an axis between two coordinates.
std::pair<double, double> find_squares(double low, double high, double middle) {
    const double first = std::floor(low + kUvRounding), last = std::ceil(high - kUvRounding) - 1;
    return first <= last ? std::pair(first, last) : std::pair(middle, middle);
}

/// The tiles of many spans. Adding one takes the same time however many tiles it has.
class TileSet {
  public:
    /// `span`: clipped.
    void add(const TileSpan& span) {
        const size_t left = size_t(span.column0), right = size_t(span.column1) + 1;
        const size_t low = size_t(span.row0), high = size_t(span.row1) + 1;
        if (changes_.empty()) changes_.resize(kWidth * size_t(kUdimRows + 1));
        ++changes_[low * kWidth + left], --changes_[low * kWidth + right];
        --changes_[high * kWidth + left], ++changes_[high * kWidth + right];
    }

    std::set<int> list() const {
        std::set<int> tiles;
        std::array<int64_t, kWidth> counts{}; // of spans in each column, below the row and in it
        for (size_t row = 0; row * kWidth < changes_.size(); ++row) {
            int64_t count = 0;
            for (size_t column = 0; column < kWidth; ++column) {
                count += counts[column] += changes_[row * kWidth + column];
                const std::optional<int> udim = find_udim(double(column), double(row));
                if (count > 0 && udim) tiles.insert(*udim);
            }
        }
        return tiles;
    }

  private:
    static constexpr size_t kWidth = kUdimColumns + 1;
    std::vector<int64_t> changes_; ///< how many more spans a square is in than those before it, rows first
};

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

TileSpan TileSpan::clip() const {
    TileSpan clipped = *this;
    clipped.column0 = std::max(column0, 0.0), clipped.column1 = std::min(column1, kUdimColumns - 1.0);
    clipped.row0 = std::max(row0, 0.0), clipped.row1 = std::min(row1, kUdimRows - 1.0);
    return clipped;
}

TileUse find_tile_use(const Mesh& mesh) {
    return find_tile_use(FaceUvs{mesh.face_sizes, mesh.uvs, mesh.uv_indices});
}

TileUse find_tile_use(const FaceUvs& faces) {
    TileUse use;
    TileSet tiles;
    std::vector<Vec2f> uvs;
    size_t first = 0;
    for (size_t face = 0; face < faces.face_sizes.size(); first += faces.face_sizes[face++]) {
        uvs.clear();
        for (size_t k = first; k < first + faces.face_sizes[face] && k < faces.indices.size(); ++k) {
            if (faces.indices[k] >= faces.uvs.size()) continue;
            const Vec2f& uv = faces.uvs[faces.indices[k]];
            uvs.push_back({uv.x * faces.scale.x + faces.offset.x, uv.y * faces.scale.y + faces.offset.y});
        }
        if (uvs.empty()) continue;
        const TileSpan span = find_tile_span(uvs);
        if (!span.is_one() && use.crossing++ == 0) use.first_crossing = face;
        const TileSpan clipped = span.clip();
        if (find_udim(clipped.column0, clipped.row0) && clipped.column0 <= clipped.column1 &&
            clipped.row0 <= clipped.row1)
            tiles.add(clipped);
        else if (use.outside++ == 0)
            use.first_outside = face;
    }
    use.tiles = tiles.list();
    return use;
}

std::set<int> find_missing_tiles(const std::set<int>& used, const std::vector<MapTile>& tiles) {
    std::set<int> missing = used;
    for (const MapTile& tile : tiles) missing.erase(tile.udim);
    return missing;
}

std::string describe_outside_faces(const TileUse& use) {
    return fmt::format("{} outside of all tiles (u from 0 to 10, v from 0), the first is face {}",
                       count_faces(use.outside, "lies", "lie"), use.first_outside);
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
        texts.push_back(fmt::format("{}: no map can displace them; move their uvs into a tile",
                                    describe_outside_faces(use)));
    return texts;
}

std::vector<std::string> find_tile_warnings(const Mesh& mesh, const Displacement& map) {
    std::vector<std::string> warnings;
    if (!map.is_udim) return warnings;
    const TileUse use = find_tile_use(mesh);
    if (const std::set<int> missing = find_missing_tiles(use.tiles, map.tiles); !missing.empty())
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
