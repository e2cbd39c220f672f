// A rectangle of a displacement map gets new texels, and which patches see that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/patch/surface.h"

namespace relief {

/// Copies `source` to column x, row y of `target`, where it fits; rounded where the target holds halves.
void copy_texels(const Texture& source, Texture& target, uint32_t x, uint32_t y);

/// One byte a patch: 1 where the displacement of any of its samples, its normals, or the level of one of its
/// edges may read a texel that has changed in tile `tile`: one rectangle for each image, the map itself first
/// and then its copies, if it has any. With `reach`, a number a patch, also where it may read one beyond its
/// sides, by that part of its length: as shading normals do, which are differences one cell wide.
std::vector<uint8_t> find_touched_patches(const Surface& surface, TileIndex tile,
                                          std::span<const TexelRectangle> changed,
                                          std::span<const float> reach = {});

} // namespace relief
