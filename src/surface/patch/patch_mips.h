// Which copies of its map a filtered surface reads: those whose texels are as large as the cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/patch/level_field.h"
#include "surface/patch/surface.h"

namespace relief {

/// One word a patch (formulas/mips.h), from the levels of all instances of the surface: the finest that one
/// of them needs. The copy of an edge depends on the edge alone, that of a corner on the edges that meet
/// there, so that patches agree wherever they meet. Empty where the map is neither filtered nor has autobump.
std::vector<uint32_t> choose_mips(const Surface& surface, std::span<const LevelField* const> levels);

} // namespace relief
