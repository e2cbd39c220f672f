// Sixteen members of an array, or what is left of it, in lanes and back.
#pragma once

#include <cstring>

#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE::wide {

RELIEF_INLINE Vec3 spread(const Vec3f& v) { return {Float(v.x), Float(v.y), Float(v.z)}; }

/// The lanes of `count` members, at most sixteen.
RELIEF_INLINE LaneMask first_lanes(size_t count) { return count >= 16 ? 0xffffu : (1u << count) - 1; }

/// Lanes beyond `count` are 0.
RELIEF_INLINE Vec2 load_pairs(const Vec2f* source, size_t count) {
    alignas(64) float pairs[32] = {};
    std::memcpy(pairs, source, HWY_MIN(count, size_t(16)) * sizeof(Vec2f));
    Vec2 result;
    Float::load_pairs(pairs, result.x, result.y);
    return result;
}

/// The same of vectors.
RELIEF_INLINE Vec3 load_vectors(const Vec3f* source, size_t count) {
    alignas(64) float packed[48] = {};
    std::memcpy(packed, source, HWY_MIN(count, size_t(16)) * sizeof(Vec3f));
    Vec3 result;
    for (size_t p = 0; p < Float::kParts; ++p)
        hn::LoadInterleaved3(Float::D(), packed + 3 * p * Float::kLanes, result.x.part[p], result.y.part[p],
                             result.z.part[p]);
    return result;
}

RELIEF_INLINE void store_vectors(const Vec3& vectors, size_t count, Vec3f* target) {
    alignas(64) float packed[48];
    for (size_t p = 0; p < Float::kParts; ++p)
        hn::StoreInterleaved3(vectors.x.part[p], vectors.y.part[p], vectors.z.part[p], Float::D(),
                              packed + 3 * p * Float::kLanes);
    std::memcpy(target, packed, HWY_MIN(count, size_t(16)) * sizeof(Vec3f));
}

/// Calls step(round, first, count - first) per sixteen, in rounds: each step prefetches for the next.
template <class Round, class... Steps> RELIEF_INLINE void run_rounds(size_t count, Steps... steps) {
    constexpr size_t kRounds = 4;
    for (size_t begin = 0; begin < count; begin += 16 * kRounds) {
        Round rounds[kRounds];
        const auto run = [&](auto step) HWY_ATTR {
            for (size_t k = 0, first = begin; k < kRounds && first < count; ++k, first += 16)
                step(rounds[k], first, count - first);
        };
        (run(steps), ...);
    }
}

} // namespace relief::HWY_NAMESPACE::wide
HWY_AFTER_NAMESPACE();
