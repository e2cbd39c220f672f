// Bilinear look-ups at sixteen places of an image: bit-identical to those of cpu/shading/textures.
#pragma once

#include <cstring>

#include "cpu/traversal/lane_arrays-inl.h"
#include "formulas/wide-inl.h"
#include "surface/map/texel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

RELIEF_INLINE Float floor_texel(const Float& x) { return floor(x); }
#define RELIEF_LANES
#include "formulas/texture_uv.h"
#undef RELIEF_LANES

/// What lies above the first row of an image and below the last; columns are repeated.
enum class TexelRows { clamped, repeated };

/// The four texels about each of sixteen places of an image.
struct FourTexelLanes {
    alignas(64) uint32_t left[16], right[16], top[16], bottom[16]; ///< columns and rows
    alignas(64) float fx[16], fy[16];

    /// `at`: in texels from the centre of texel (0, 0), at most one outside of the image.
    RELIEF_INLINE void place(const Texture& texture, const Vec2& at, TexelRows rows) {
        const Float zero(0.0f), one(1.0f);
        const Float width(float(texture.width)), height(float(texture.height));
        const Float x = floor(at.x), y = floor(at.y);
        (at.x - x).store(fx), (at.y - y).store(fy);
        // NaN lies nowhere: any texel.
        const auto store = [](const Float& value, uint32_t count, uint32_t* target)
                               HWY_ATTR { min(Uint(value), Uint(count - 1)).store(target); };
        const auto before = [&](const Float& value, const Float& size)
                                HWY_ATTR { return select(value < zero, value + size, value); };
        const auto behind = [&](const Float& value, const Float& size)
                                HWY_ATTR { return select(value + one < size, value + one, zero); };
        const bool is_repeated = rows == TexelRows::repeated;
        store(before(x, width), texture.width, left);
        store(behind(x, width), texture.width, right);
        store(is_repeated ? before(y, height) : max(y, zero), texture.height, top);
        store(is_repeated ? behind(y, height) : min(y + one, height - one), texture.height, bottom);
    }

    RELIEF_INLINE void prefetch(const Texture& texture, LaneMask which) const {
        for (; which != 0; which &= which - 1) {
            const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(which);
            // Both texels of a row mostly share a line of the cache.
            prefetch_texel(texture, size_t(top[lane]) * texture.width + right[lane]);
            prefetch_texel(texture, size_t(bottom[lane]) * texture.width + right[lane]);
        }
    }

    /// Colour, bilinear; of the other lanes 0.
    RELIEF_INLINE Vec3 fetch(const Texture& texture, LaneMask which) const {
        LaneQuads colors;
        if (which != 0xffffu) std::memset(&colors, 0, sizeof colors);
        for (; which != 0; which &= which - 1) {
            const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(which);
            const auto load = [&](uint32_t row, uint32_t column) HWY_ATTR {
                return load_texel(texture, size_t(row) * texture.width + column);
            };
            texel::filter_texels(load(top[lane], left[lane]), load(top[lane], right[lane]),
                                 load(bottom[lane], left[lane]), load(bottom[lane], right[lane]),
                                 Lanes4(fx[lane]), Lanes4(fy[lane]))
                .store_unaligned(colors.lane[lane]);
        }
        Float r, g, b, alpha;
        colors.transpose(r, g, b, alpha);
        const bool is_grey = texture.channel_count < 3;
        return {r, is_grey ? r : g, is_grey ? r : b};
    }
};

/// fetch_texture() at finite places, of a texture that is no B-spline.
inline void fetch_texture(const Texture& texture, const Vec2f* uvs, size_t count, Vec3f* colors) {
    const Vec2 size{Float(float(texture.width)), Float(float(texture.height))};
    const auto place = [&](FourTexelLanes& places, size_t first, size_t left) HWY_ATTR {
        places.place(texture, locate_texture_uv(load_pairs(uvs + first, left), size), TexelRows::repeated);
        places.prefetch(texture, first_lanes(left));
    };
    const auto fetch = [&](const FourTexelLanes& places, size_t first, size_t left) HWY_ATTR {
        store_vectors(places.fetch(texture, first_lanes(left)), left, colors + first);
    };
    run_rounds<FourTexelLanes>(count, place, fetch);
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
