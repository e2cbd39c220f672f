// Texels of images, their four channels in one register.
#if defined(RELIEF_TEXEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_TEXEL_LANES_INL_H
#undef RELIEF_TEXEL_LANES_INL_H
#else
#define RELIEF_TEXEL_LANES_INL_H
#endif

#include "formulas/lanes-inl.h"
#include "relief/image.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

HWY_INLINE Lanes4 load_texel(const Texture& texture, size_t index) {
    if (!texture.floats.empty()) return Lanes4::load_unaligned(texture.floats.data() + 4 * index);
    const hn::FixedTag<float, 4> d;
    const hn::Rebind<hwy::float16_t, decltype(d)> d16;
    const auto halves =
        hn::LoadU(d16, reinterpret_cast<const hwy::float16_t*>(texture.halves.data() + 4 * index));
    Lanes4 result;
    result.part[0] = hn::PromoteTo(d, halves);
    return result;
}

/// Two texels, one after the other. A template, so that each instruction set compiles its own branch only.
template <class Pair = Lanes8>
HWY_INLINE Pair load_texel_pair(const Texture& texture, size_t first, size_t second) {
    Pair pair;
    if constexpr (Pair::kParts == 1) {
        const typename Pair::D d;
        const hn::Rebind<hwy::float16_t, typename Pair::D> d16;
        const hn::Half<typename Pair::D> half;
        const hn::Half<decltype(d16)> half16;
        const auto* halves = reinterpret_cast<const hwy::float16_t*>(texture.halves.data());
        const float* floats = texture.floats.data();
        pair.part[0] =
            texture.floats.empty()
                ? hn::PromoteTo(d, hn::Combine(d16, hn::LoadU(half16, halves + 4 * second),
                                               hn::LoadU(half16, halves + 4 * first)))
                : hn::Combine(d, hn::LoadU(half, floats + 4 * second), hn::LoadU(half, floats + 4 * first));
    } else {
        pair.part[0] = load_texel(texture, first).part[0];
        pair.part[1] = load_texel(texture, second).part[0];
    }
    return pair;
}

/// Red, green and blue of sixteen texels, one after another in memory, the first at `index`.
HWY_INLINE void load_texels(const Texture& texture, size_t index, Lanes16 (&color)[3]) {
    using D = Lanes16::D;
    alignas(64) float promoted[64];
    const float* source = texture.floats.data() + 4 * index;
    if (texture.floats.empty()) {
        for (size_t k = 0; k < 16; ++k) load_texel(texture, index + k).store(promoted + 4 * k);
        source = promoted;
    }
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        hn::Vec<D> alpha;
        hn::LoadInterleaved4(D(), source + 4 * p * Lanes16::kLanes, color[0].part[p], color[1].part[p],
                             color[2].part[p], alpha);
    }
}

HWY_INLINE void prefetch_texel(const Texture& texture, size_t index) {
    if (texture.halves.empty())
        __builtin_prefetch(texture.floats.data() + 4 * index);
    else
        __builtin_prefetch(texture.halves.data() + 4 * index);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
