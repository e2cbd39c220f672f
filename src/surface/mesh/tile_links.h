// Tiles of a UDIM map that a mesh goes on from one into another, so that filters read across their border.
#pragma once

#include <vector>

#include "relief/scene.h"
#include "surface/patch/surface.h"

namespace relief {

/// Neighbours of each tile: those that share an edge of two faces along their border, in uvs and in points,
/// and those that one face lies across. Points count as one where join_points() joins them. `tiles`: of a map
/// whose row 0 is v = 1 unless `flip_v`.
std::vector<TileNeighbours> find_tile_links(const Mesh& mesh, const std::vector<MapTile>& tiles, bool flip_v);

/// Adds those of another mesh.
void join_tile_links(const std::vector<TileNeighbours>& more, std::vector<TileNeighbours>& links);

} // namespace relief
