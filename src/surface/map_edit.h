// A rectangle of a displacement map gets new texels, and which patches see that.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/surface.h"

namespace relief {

/// Copies all of `source` to column x, row y of `target`, where it has room; rounded to halves where the
/// target holds such.
void copy_texels(const Texture& source, Texture& target, uint32_t x, uint32_t y);

/// One byte a patch: 1 where the displacement of any of its samples, or the level of one of its edges, may
/// read a texel of the rectangle (inside the map) of tile `tile`.
std::vector<uint8_t> find_touched_patches(const Surface& surface, uint8_t tile,
                                          const TexelRectangle& changed);

} // namespace relief
