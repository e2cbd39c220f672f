// The gutter: texels between the islands of a map that fetches read but nothing was baked into. They are
// given the values beside them, so that the background does not bleed into the surface along its seams.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "relief/scene.h"
#include "surface/map/texel_range.h"
#include "surface/mesh/uv_outlines.h"

namespace relief {

/// Which texels of one image take the values of which others, wherever they hold the background's.
struct GutterFill {
    struct Copy {
        uint32_t to_x, to_y, from_x, from_y;
        bool is_done = false; ///< the texel held the background's value and has the other's now
    };
    std::vector<Copy> copies;
    std::array<uint32_t, 3> background{}; ///< bits of the first three channels, as floats

    /// Texels that bilinear fetches read are copied no farther than that, in either direction.
    static constexpr uint32_t kReach = 2;
    /// Texels beyond those that take the same values in turn: a B-spline reads one more; of a spline through
    /// the texels what lies in the way of the coefficients counts, each a quarter of the one before.
    static constexpr int kSplineSpread = 1, kCubicSpread = 12;

    void apply(Texture& texture);
    /// Updates the gutter after a change of values in a rectangle. Returns all that has changed.
    TexelRectangle follow(Texture& texture, const TexelRectangle& changed);
};

/// Texels of a tile along the uv islands' borders with centres outside of all faces. Where most of them
/// hold one value it is the background's, and these are to take the nearest inside value; else the map is
/// padded already.
GutterFill find_gutter(const Displacement& displacement, const MapTile& tile,
                       std::span<const UvOutlines* const> meshes);

} // namespace relief
