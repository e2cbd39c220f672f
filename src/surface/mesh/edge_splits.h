// Which edges of quads are cut in the middle, so that every quad can be cut into quads.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/mesh/cage.h"

namespace relief {

/// Adds splits to `is_split` (one per edge) until all edges of faces that are not quads are split, and each
/// quad has an even number of split edges: quads with an odd number are joined in pairs, or with a boundary,
/// by short ways across edges that are not split yet.
void make_splits_even(const Cage& cage, std::vector<uint8_t>& is_split);

} // namespace relief
