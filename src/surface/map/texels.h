// Raw texels by integer coordinates: the wrap modes, four channels to three.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "formulas/displace.h"
#include "formulas/texel.h"
#include "image/texel_layout.h"
#include "relief/scene.h"

namespace relief {

using scalar::floor_texel;

/// Beyond it an index is brought near first: formulas/texel.h counts in 32 bits.
inline constexpr int32_t kFarTexel = 1 << 30;
static_assert(uint32_t(WrapMode::clamp) == scalar::kWrapClamp &&
              uint32_t(WrapMode::repeat) == scalar::kWrapRepeat &&
              uint32_t(WrapMode::mirror) == scalar::kWrapMirror &&
              uint32_t(WrapMode::black) == scalar::kWrapBlack);
/// Texel that `index` reads of `size`; -1 outside of WrapMode::black. 2 size must be representable.
template <class Index> Index wrap_index(Index index, std::type_identity_t<Index> size, WrapMode wrap) {
    // Both periods divide twice the size.
    if (index > kFarTexel || index < -kFarTexel)
        index = wrap == WrapMode::repeat || wrap == WrapMode::mirror ? index % (2 * size)
                                                                     : (index < 0 ? Index(-1) : size);
    return scalar::wrap_texel(int32_t(index), int32_t(size), uint32_t(wrap));
}

/// The texel in column x and row y, both inside the texture: four channels, so that it fills a register.
inline std::array<float, 4> read_channels(const Texture& texture, int64_t x, int64_t y) {
    const size_t place = texture.find_texel(size_t(x), size_t(y));
    std::array<float, 4> texel{0, 0, 0, 1};
    for (size_t c = 0; c < texture.stride; ++c) texel[c] = load_value(texture, place + c);
    return texel;
}

/// Bilinear value between four texels.
inline std::array<float, 4> filter_channels(const std::array<float, 4>& t00, const std::array<float, 4>& t10,
                                            const std::array<float, 4>& t01, const std::array<float, 4>& t11,
                                            float fx, float fy) {
    std::array<float, 4> value;
    for (size_t c = 0; c < 4; ++c) value[c] = scalar::filter_texels(t00[c], t10[c], t01[c], t11[c], fx, fy);
    return value;
}

/// Value at (fx, fy) of a bicubic B-spline between coefficients; `read` gets their column and row, 0 to 3.
template <class Read> std::array<float, 4> filter_spline(const Read& read, float fx, float fy) {
    const scalar::CubicWeights along = scalar::weigh_spline(fx), across = scalar::weigh_spline(fy);
    std::array<std::array<float, 4>, 4> rows;
    for (size_t j = 0; j < 4; ++j) {
        const std::array<float, 4> t0 = read(0, j), t1 = read(1, j), t2 = read(2, j), t3 = read(3, j);
        for (size_t c = 0; c < 4; ++c) rows[j][c] = scalar::blend_cubic(t0[c], t1[c], t2[c], t3[c], along);
    }
    std::array<float, 4> value;
    for (size_t c = 0; c < 4; ++c)
        value[c] = scalar::blend_cubic(rows[0][c], rows[1][c], rows[2][c], rows[3][c], across);
    return value;
}

/// First three channels of the texel in column x and row y, both inside the texture.
inline std::array<float, 3> read_texel(const Texture& texture, int64_t x, int64_t y) {
    const size_t place = texture.find_texel(size_t(x), size_t(y));
    if (texture.stride == 1) return {load_value(texture, place), 0, 0};
    return {load_value(texture, place), load_value(texture, place + 1), load_value(texture, place + 2)};
}

} // namespace relief
