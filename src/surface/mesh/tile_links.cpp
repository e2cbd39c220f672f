#include "surface/mesh/tile_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/udim.h"
#include "scene/tile_use.h"
#include "surface/mesh/join_points.h"

namespace relief {

namespace {

/// Collects links while it walks through the faces of a mesh.
class LinkFinder {
  public:
    LinkFinder(const Mesh& mesh, const std::vector<MapTile>& tiles, bool flip_v)
        : mesh_(mesh), flip_v_(flip_v), points_(join_points(mesh).representatives), links_(tiles.size()) {
        for (size_t k = 0; k < tiles.size(); ++k) number_of_[tiles[k].udim] = TileIndex(k);
        for (TileNeighbours& links : links_) links.fill(Surface::kNoTile);
    }

    std::vector<TileNeighbours> run() {
        std::vector<Vec2f> uvs;
        size_t first = 0;
        for (const uint32_t size : mesh_.face_sizes) {
            uvs.clear();
            for (size_t k = first; k < first + size; ++k)
                if (is_sound(k)) uvs.push_back(mesh_.uvs[mesh_.uv_indices[k]]);
            if (uvs.size() == size) add_face(first, uvs);
            first += size;
        }
        return std::move(links_);
    }

  private:
    struct Border {
        uint32_t low, high; ///< points
        bool is_column;     ///< between two columns of tiles; else between two rows
        double line;        ///< the greater of the numbers of both columns or rows
        friend auto operator<=>(const Border&, const Border&) = default;
    };

    bool is_sound(size_t corner) const {
        return corner < mesh_.uv_indices.size() && mesh_.uv_indices[corner] < mesh_.uvs.size() &&
               corner < mesh_.position_indices.size() &&
               mesh_.position_indices[corner] < mesh_.positions.size();
    }

    TileIndex find_tile(double column, double row) const {
        const auto found = number_of_.find(find_udim(column, row).value_or(0));
        return found == number_of_.end() ? Surface::kNoTile : found->second;
    }

    /// Links the squares at (column, row) and to its right or, with `is_column` false, above it in uv.
    void link(double column, double row, bool is_column) {
        const TileIndex a = find_tile(column, row),
                        b = is_column ? find_tile(column + 1, row) : find_tile(column, row + 1);
        if (a == Surface::kNoTile || b == Surface::kNoTile) return;
        const size_t to_b = is_column ? 1 : flip_v_ ? 3 : 2, to_a = is_column ? 0 : flip_v_ ? 2 : 3;
        links_[a][to_b] = b, links_[b][to_a] = a;
    }

    void add_face(size_t first, const std::vector<Vec2f>& uvs) {
        const TileSpan span = find_tile_span(uvs).clip();
        for (double row = span.row0; row <= span.row1; ++row)
            for (double column = span.column0; column <= span.column1; ++column) {
                if (column < span.column1) link(column, row, true);
                if (row < span.row1) link(column, row, false);
            }
        for (size_t k = 0; k < uvs.size(); ++k) add_edge(first, k, uvs, span);
    }

    void add_edge(size_t first, size_t k, const std::vector<Vec2f>& uvs, const TileSpan& span) {
        const size_t next = (k + 1) % uvs.size();
        const Vec2f &a = uvs[k], &b = uvs[next];
        const auto is_along = [](double from, double to) {
            const double line = std::round(from);
            return std::fabs(from - line) <= kUvRounding && std::fabs(to - line) <= kUvRounding;
        };
        const bool is_column = is_along(a.x, b.x);
        if (!is_column && !is_along(a.y, b.y)) return;
        const double line = std::round(is_column ? double(a.x) : double(a.y));
        const auto [low, high] = std::minmax(get_point(first + k), get_point(first + next));
        const std::array<double, 2> square = {span.middle_column, span.middle_row};
        const auto [place, is_new] = edges_.try_emplace({low, high, is_column, line}, square);
        if (is_new || place->second == square) return;
        const double column = std::min(square[0], place->second[0]),
                     row = std::min(square[1], place->second[1]);
        const double columns = std::fabs(square[0] - place->second[0]),
                     rows = std::fabs(square[1] - place->second[1]);
        if (is_column && columns == 1 && rows == 0) link(column, row, true);
        if (!is_column && columns == 0 && rows == 1) link(column, row, false);
    }

    const uint32_t& get_point(size_t corner) const { return points_[mesh_.position_indices[corner]]; }

    const Mesh& mesh_;
    const bool flip_v_;
    const std::vector<uint32_t> points_;            ///< that surfaces have in place of the mesh's
    std::map<int, TileIndex> number_of_;            ///< of tiles, by their UDIM number
    std::map<Border, std::array<double, 2>> edges_; ///< squares of the first faces at edges along borders
    std::vector<TileNeighbours> links_;
};

} // namespace

std::vector<TileNeighbours> find_tile_links(const Mesh& mesh, const std::vector<MapTile>& tiles,
                                            bool flip_v) {
    return LinkFinder(mesh, tiles, flip_v).run();
}

void join_tile_links(const std::vector<TileNeighbours>& more, std::vector<TileNeighbours>& links) {
    if (links.empty()) links = more;
    for (size_t tile = 0; tile < more.size(); ++tile)
        for (size_t k = 0; k < more[tile].size(); ++k)
            if (more[tile][k] != Surface::kNoTile) links[tile][k] = more[tile][k];
}

} // namespace relief
