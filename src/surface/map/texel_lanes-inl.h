// Texels of images, their four channels in one register.
#if defined(RELIEF_TEXEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_TEXEL_LANES_INL_H
#undef RELIEF_TEXEL_LANES_INL_H
#else
#define RELIEF_TEXEL_LANES_INL_H
#endif

#include <limits>

#include "formulas/lanes-inl.h"
#include "relief/image.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Halves as floats. Where Highway converts without an instruction, it takes infinities and NaN for numbers
/// from 65536 on, which no half is: their exponent becomes that of infinities.
template <class D> HWY_INLINE hn::Vec<D> promote_halves(D d, const uint16_t* halves) {
    const hn::Rebind<hwy::float16_t, D> d16;
    const auto value = hn::PromoteTo(d, hn::LoadU(d16, reinterpret_cast<const hwy::float16_t*>(halves)));
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE2 ||                           \
    HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
    const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    return hn::IfThenElse(hn::Lt(hn::Abs(value), hn::Set(d, 65536.0f)), value, hn::Or(value, infinity));
#else
    return value;
#endif
}

/// The fourth lane holds anything where there are three channels; of one channel the rest is 0.
HWY_INLINE Lanes4 load_texel(const Texture& texture, size_t index) {
    const hn::FixedTag<float, 4> d;
    const size_t place = texture.stride * index;
    Lanes4 result;
    if (texture.halves.empty()) {
        result.part[0] = hn::LoadU(d, texture.floats.data() + place);
    } else {
        result.part[0] = promote_halves(d, texture.halves.data() + place);
    }
    if (texture.stride == 1) result.part[0] = hn::IfThenElseZero(hn::FirstN(d, 1), result.part[0]);
    return result;
}

/// Two texels, one after the other. A template, so that each instruction set compiles its own branch only.
template <class Pair = Lanes8>
HWY_INLINE Pair load_texel_pair(const Texture& texture, size_t first, size_t second) {
    Pair pair;
    if constexpr (Pair::kParts == 1) {
        const typename Pair::D d;
        pair.part[0] =
            hn::Combine(d, load_texel(texture, second).part[0], load_texel(texture, first).part[0]);
    } else {
        pair.part[0] = load_texel(texture, first).part[0];
        pair.part[1] = load_texel(texture, second).part[0];
    }
    return pair;
}

/// As floats; `count` is a multiple of sixteen.
HWY_INLINE void promote_halves(const uint16_t* halves, size_t count, float* floats) {
    const Lanes16::D d;
    for (size_t k = 0; k < count; k += Lanes16::kLanes)
        hn::Store(promote_halves(d, halves + k), d, floats + k);
}

/// Red, green and blue of sixteen texels, one after another in memory, the first at `index`.
HWY_INLINE void load_texels(const Texture& texture, size_t index, Lanes16 (&color)[3]) {
    using D = Lanes16::D;
    alignas(64) float promoted[64];
    const size_t stride = texture.stride;
    const float* source = promoted;
    if (texture.halves.empty())
        source = texture.floats.data() + stride * index;
    else
        promote_halves(texture.halves.data() + stride * index, 16 * stride, promoted);
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        const float* texels = source + stride * p * Lanes16::kLanes;
        hn::Vec<D> alpha;
        if (stride == 4) {
            hn::LoadInterleaved4(D(), texels, color[0].part[p], color[1].part[p], color[2].part[p], alpha);
        } else if (stride == 3) {
            hn::LoadInterleaved3(D(), texels, color[0].part[p], color[1].part[p], color[2].part[p]);
        } else {
            color[0].part[p] = hn::LoadU(D(), texels);
            color[1].part[p] = color[2].part[p] = hn::Zero(D());
        }
    }
}

HWY_INLINE void prefetch_texel(const Texture& texture, size_t index) {
    const size_t place = texture.stride * index;
    if (texture.halves.empty())
        __builtin_prefetch(texture.floats.data() + place);
    else
        __builtin_prefetch(texture.halves.data() + place);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
