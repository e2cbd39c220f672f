// Mip levels of a map that a patch's samples read, filtered by cell size: one packed word a patch.
#ifndef RELIEF_MIPS_H
#define RELIEF_MIPS_H
#include "formulas/begin.h"

/// The coarsest mip level; 0 is the map itself.
const uint kMaxMip = 7u;

// Locations on a patch: interior, edge k, corner k; edges and corners agree in all adjacent patches.
const uint kMipInside = 0u;
const uint kMipEdges = 1u;
const uint kMipCorners = 5u;

FN uint packed_mip(const uint packed, const uint place) { return (packed >> (3u * place)) & 7u; }
FN uint pack_mip(const uint mip, const uint place) { return mip << (3u * place); }

// With autobump the top five bits hold 1 + the level whose cells are as large as texels.
const uint kDetailShift = 27u;
FN bool has_detail(const uint packed) { return (packed >> kDetailShift) != 0u; }

/// Level whose cell size is the finite-difference step of shading normals.
FN uint choose_normal_level(const uint packed, const uint level) {
    uint detail = packed >> kDetailShift;
    return detail > level + 1u ? detail - 1u : level;
}

/// Mip level that shading normals read.
FN uint choose_normal_mip(const uint packed) {
    return has_detail(packed) ? 0u : packed_mip(packed, kMipInside);
}

#include "formulas/end.h"
#endif
