// Texels of images, their four channels in one register.
#if defined(RELIEF_TEXEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_TEXEL_LANES_INL_H
#undef RELIEF_TEXEL_LANES_INL_H
#else
#define RELIEF_TEXEL_LANES_INL_H
#endif

#include "math/lanes-inl.h"
#include "relief/scene.h"

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

HWY_INLINE void prefetch_texel(const Texture& texture, size_t index) {
    if (texture.halves.empty())
        __builtin_prefetch(texture.floats.data() + 4 * index);
    else
        __builtin_prefetch(texture.halves.data() + 4 * index);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
