// Random numbers of many paths, sixteen at a time.
#if defined(RELIEF_RANDOM_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_RANDOM_PAIRS_INL_H
#undef RELIEF_RANDOM_PAIRS_INL_H
#else
#define RELIEF_RANDOM_PAIRS_INL_H
#endif

#include <cstring>

#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// scalar::sobol_pair for each seed.
inline void draw_pairs(const uint32_t* seeds, size_t count, uint32_t sample_index, uint32_t pair,
                       Vec2f* drawn) {
    for (size_t first = 0; first < count; first += 16) {
        const size_t size = HWY_MIN(size_t(16), count - first);
        alignas(64) uint32_t seed[16] = {};
        std::memcpy(seed, seeds + first, size * sizeof(uint32_t));
        const wide::Vec2 u = wide::sobol_pair(wide::Uint::load(seed), sample_index, pair);
        alignas(64) float x[16], y[16];
        u.x.store(x), u.y.store(y);
        for (size_t lane = 0; lane < size; ++lane) drawn[first + lane] = {x[lane], y[lane]};
    }
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
