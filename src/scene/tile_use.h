// Which UDIM tiles the faces of a mesh lie in, and which faces lie in none or in several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/udim.h"
#include "relief/scene.h"

namespace relief {

/// Unit squares of the uv plane that a face lies in: columns [column0, column1], rows [row0, row1].
struct TileSpan {
    double column0, row0, column1, row1;
    double middle_column, middle_row; ///< square of the middle of the corners

    bool is_one() const { return column0 == column1 && row0 == row1; }
    bool holds(const UdimSquare& square) const {
        return square.column >= column0 && square.column <= column1 && square.row >= row0 &&
               square.row <= row1;
    }
    /// The part where tiles have numbers, of at most kUdimColumns x kUdimRows squares. Where there is none, a
    /// last column or row is less than the first one.
    TileSpan clip() const;
};

/// Squares that the corners reach into by more than the rounding of uvs; a face that lies on a border alone
/// belongs to the square of its middle.
TileSpan find_tile_span(std::span<const Vec2f> uvs);

struct TileUse {
    std::set<int> tiles;              ///< numbers of all tiles that faces reach into
    size_t crossing = 0, outside = 0; ///< faces in several squares, and faces that reach into no tile
    size_t first_crossing = 0, first_outside = 0; ///< index of the first, where there is one
};

/// One set of uvs of the faces of a mesh, as a texture reads it: times `scale`, plus `offset`.
struct FaceUvs {
    std::span<const uint32_t> face_sizes;
    std::span<const Vec2f> uvs;
    std::span<const uint32_t> indices; ///< one a corner
    Vec2f scale{1, 1}, offset{};
};

/// Indices out of range and faces without uvs are left out.
TileUse find_tile_use(const FaceUvs& faces);
/// The same of the mesh's own uvs.
TileUse find_tile_use(const Mesh& mesh);

/// Numbers of `used` tiles that are not among the tiles of a map.
std::set<int> find_missing_tiles(const std::set<int>& used, const std::vector<MapTile>& tiles);

/// "2 faces lie outside of all tiles (u from 0 to 10, v from 0), the first is face 3"; some must.
std::string describe_outside_faces(const TileUse& use);

/// Texts about the faces of a mesh that lie across tiles of a map or outside of all of them; without names.
std::vector<std::string> describe_misplaced_faces(const TileUse& use);

/// Warnings about a mesh and its map with tiles: files that are missing, and faces across tiles or outside of
/// all of them. Nothing for other maps.
std::vector<std::string> find_tile_warnings(const Mesh& mesh, const Displacement& map);

} // namespace relief
