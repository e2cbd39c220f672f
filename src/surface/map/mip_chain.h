// Smaller copies of a map, for cells that are larger than its texels (Williams 1983, Pyramidal Parametrics).
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relief/scene.h"
#include "surface/map/bounds_pyramid.h"
#include "surface/map/texel_range.h"
#include "surface/mesh/uv_islands.h"

namespace relief {

/// Texels that nothing was baked into: no face covers their centre and they hold the background's value.
struct OutsideTexels {
    TexelMask uncovered; ///< empty: there are none
    TexelBits background{};

    bool holds(const Texture& texture, uint32_t x, uint32_t y) const {
        return !uncovered.is_empty() && uncovered.has(x, y) && get_texel_bits(texture, x, y) == background;
    }
};

/// Of tile `tile`, which the meshes use. The background is the value that more than half of the texels hold
/// that no face covers; where there is none, or some face runs over a map that repeats, nothing is outside.
OutsideTexels find_outside_texels(const Displacement& displacement, const MapTile& tile,
                                  std::span<const UvOutlines* const> meshes);

/// Copies 1, 2, ... of a map, each half as large (rounded up): means of what is not outside. Texels beside
/// the islands take the nearest inside value, for bilinear fetches. Thread safe but for `update`.
class MipChain {
  public:
    struct Copy {
        std::shared_ptr<Texture> texture; ///< halves where the map has halves
        std::shared_ptr<BoundsPyramid> pyramid;
        std::vector<uint8_t> is_outside; ///< one a texel, or empty: none
    };

    MipChain(const Texture& texture, OutsideTexels outside, WrapMode wrap);

    /// Copy `mip` >= 1, or the last one where there are fewer.
    const Copy& copy(uint32_t mip) const { return copies_[std::min(size_t(mip), copies_.size()) - 1]; }
    uint32_t count() const { return uint32_t(copies_.size()); }
    const OutsideTexels& outside() const { return outside_; }

    /// Follows new texels in a rectangle; returns which texels of each copy have changed, copy 1 first.
    std::vector<TexelRectangle> update(const Texture& texture, const TexelRectangle& changed);

    size_t byte_count() const;

  private:
    void average(const Texture& texture, size_t index, const TexelRectangle& where);
    void fill_borders(Copy& copy, const TexelRectangle& where) const;
    TexelRectangle remake(const Texture& texture, size_t index, const TexelRectangle& changed);

    OutsideTexels outside_;
    WrapMode wrap_;
    std::vector<Copy> copies_;
};

} // namespace relief
