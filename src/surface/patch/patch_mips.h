// Which copies of its map a filtered surface reads: those whose texels are as large as the cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/patch/level_field.h"
#include "surface/patch/surface.h"

namespace relief {

/// One word a patch (formulas/mips.h): the finest level of all instances. The copy of an edge depends on the
/// edge alone, that of a corner on its edges, so patches agree. Empty without filter and autobump.
std::vector<uint32_t> choose_mips(const Surface& surface, std::span<const LevelField* const> levels);

} // namespace relief
