// Cuts the faces of a cage in which edges are split into smaller quads that share their sides.
#pragma once

#include <functional>

#include "surface/mesh/cage.h"

namespace relief {

/// Finds the limit uv of a set at a place of a face; called face by face, in order.
using FindUv = std::function<Vec2f(uint32_t set, const QuadPlace& face, const Vec2<double>& at)>;

/// How many faces split_faces() makes.
uint64_t count_pieces(const Cage& cage, const std::vector<uint8_t>& is_split);

/// Cuts every face whose edges are split (one byte per edge; make_splits_even() has been called): quads with
/// two opposite edges into two, with two neighbouring ones into three, with four into four, and polygons with
/// other numbers of corners into one quad per corner. Other quads stay. The pieces of a face follow one
/// another. New points are in the middle of edges and faces; both sides of an edge that is no uv seam get
/// equal uvs there.
Cage split_faces(const Cage& cage, const std::vector<uint8_t>& is_split, const FindUv& find_uv);

} // namespace relief
