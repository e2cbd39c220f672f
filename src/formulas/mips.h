// Which of the smaller copies of a map the samples of a patch read, where maps are filtered by the size of
// cells: one word a patch.
#ifndef RELIEF_MIPS_H
#define RELIEF_MIPS_H
#include "formulas/begin.h"

/// The smallest copy; 0 is the map itself, each next one half as large a side.
const uint kMaxMip = 7u;

// Places of a patch: inside, on edge k, at corner k. Edges and corners have the same copy in all their
// patches.
const uint kMipInside = 0u;
const uint kMipEdges = 1u;
const uint kMipCorners = 5u;

FN uint packed_mip(uint packed, uint place) { return (packed >> (3u * place)) & 7u; }
FN uint pack_mip(uint mip, uint place) { return mip << (3u * place); }

// Where normals keep the detail that cells do not have, the top five bits hold 1 + the level whose cells are
// as large as texels.
const uint kDetailShift = 27u;
FN bool has_detail(uint packed) { return (packed >> kDetailShift) != 0u; }

/// Level whose cells the differences of shading normals are as wide as.
FN uint choose_normal_level(uint packed, uint level) {
    uint detail = packed >> kDetailShift;
    return detail > level + 1u ? detail - 1u : level;
}

/// Copy that shading normals read.
FN uint choose_normal_mip(uint packed) { return has_detail(packed) ? 0u : packed_mip(packed, kMipInside); }

#include "formulas/end.h"
#endif
