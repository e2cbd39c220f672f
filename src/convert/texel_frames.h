// The frame of a surface at each texel of its map: what turns tangent space into object space and back.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "relief/progress.h"
#include "surface/patch/surface.h"

namespace relief {

/// Columns t, b, n as the surface uses them: blended between corners, not of unit length.
using FrameMatrix = std::array<Vec3f, 3>;

struct TexelFrame {
    FrameMatrix axes;
    std::array<float, 3>
        lengths{}; ///< of the axes at the corners, blended: what `axes` would have if all agreed
};

/// Calls `visit(x, y, frame)` for the texels of a tile that a patch covers or touches (up to 1.5 texels
/// beside it), again where another patch is nearer: the last call counts. `surface` needs tangent frames.
void visit_texel_frames(const Surface& surface, TileIndex tile,
                        const std::function<void(uint32_t x, uint32_t y, const TexelFrame& frame)>& visit,
                        const ProgressFunction& on_progress);

} // namespace relief
