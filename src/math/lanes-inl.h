// Sixteen (or eight, or four) floats as one value on every instruction set: one register on AVX-512, two on
// AVX2, four on SSE4 and NEON, emulated without SIMD. Compiled once per target by Highway; use inside
// HWY_NAMESPACE only. Every operation rounds once and nothing is fused, so that results are the same bits on
// every target.
#if defined(RELIEF_MATH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_MATH_LANES_INL_H
#undef RELIEF_MATH_LANES_INL_H
#else
#define RELIEF_MATH_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "math/vec.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One bit a lane.
using LaneMask = uint32_t;

template <size_t kWidth> struct Lanes {
    using D = hn::CappedTag<float, kWidth>;
    using V = hn::Vec<D>;
    static constexpr size_t kLanes = hn::MaxLanes(D());
    static constexpr size_t kParts = kWidth / kLanes;

    V part[kParts];

    Lanes() = default;
    HWY_INLINE explicit Lanes(float value) {
        for (size_t p = 0; p < kParts; ++p) part[p] = hn::Set(D(), value);
    }
    static HWY_INLINE Lanes load(const float* aligned) {
        Lanes r;
        for (size_t p = 0; p < kParts; ++p) r.part[p] = hn::Load(D(), aligned + p * kLanes);
        return r;
    }
    static HWY_INLINE Lanes load_unaligned(const float* source) {
        Lanes r;
        for (size_t p = 0; p < kParts; ++p) r.part[p] = hn::LoadU(D(), source + p * kLanes);
        return r;
    }
    /// Codes of a quantised box as floats, exactly.
    static HWY_INLINE Lanes load_codes(const uint8_t* source) {
        const hn::Rebind<uint8_t, D> d8;
        const hn::Rebind<int32_t, D> d32;
        Lanes r;
        for (size_t p = 0; p < kParts; ++p)
            r.part[p] = hn::ConvertTo(D(), hn::PromoteTo(d32, hn::LoadU(d8, source + p * kLanes)));
        return r;
    }
    HWY_INLINE void store(float* aligned) const {
        for (size_t p = 0; p < kParts; ++p) hn::Store(part[p], D(), aligned + p * kLanes);
    }
    HWY_INLINE void store_unaligned(float* target) const {
        for (size_t p = 0; p < kParts; ++p) hn::StoreU(part[p], D(), target + p * kLanes);
    }
    /// floor, as 32-bit integers in memory.
    HWY_INLINE void store_as_integers(int32_t* aligned) const {
        const hn::Rebind<int32_t, D> d32;
        for (size_t p = 0; p < kParts; ++p) hn::Store(hn::ConvertTo(d32, part[p]), d32, aligned + p * kLanes);
    }
};

#define RELIEF_LANES_BINARY(name, function)                                                                  \
    template <size_t W> HWY_INLINE Lanes<W> name(const Lanes<W>& a, const Lanes<W>& b) {                     \
        Lanes<W> r;                                                                                          \
        for (size_t p = 0; p < Lanes<W>::kParts; ++p) r.part[p] = hn::function(a.part[p], b.part[p]);        \
        return r;                                                                                            \
    }
RELIEF_LANES_BINARY(operator+, Add)
RELIEF_LANES_BINARY(operator-, Sub)
RELIEF_LANES_BINARY(operator*, Mul)
RELIEF_LANES_BINARY(operator/, Div)
RELIEF_LANES_BINARY(min, Min)
RELIEF_LANES_BINARY(max, Max)
#undef RELIEF_LANES_BINARY

template <size_t W> HWY_INLINE Lanes<W> floor(const Lanes<W>& a) {
    Lanes<W> r;
    for (size_t p = 0; p < Lanes<W>::kParts; ++p) r.part[p] = hn::Floor(a.part[p]);
    return r;
}

template <class D, class M> HWY_INLINE LaneMask to_bits(D d, M mask) {
    alignas(8) uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    LaneMask bits = bytes[0];
    if constexpr (hn::MaxLanes(D()) > 8) bits |= LaneMask(bytes[1]) << 8;
    return bits;
}

#define RELIEF_LANES_COMPARE(name, function)                                                                 \
    template <size_t W> HWY_INLINE LaneMask name(const Lanes<W>& a, const Lanes<W>& b) {                     \
        LaneMask bits = 0;                                                                                   \
        for (size_t p = 0; p < Lanes<W>::kParts; ++p)                                                        \
            bits |= to_bits(typename Lanes<W>::D(), hn::function(a.part[p], b.part[p]))                      \
                    << (p * Lanes<W>::kLanes);                                                               \
        return bits;                                                                                         \
    }
RELIEF_LANES_COMPARE(less_equal, Le)
RELIEF_LANES_COMPARE(less, Lt)
RELIEF_LANES_COMPARE(not_equal, Ne)
#undef RELIEF_LANES_COMPARE

/// Lanes inside [0, +inf) in all three, or inside (-inf, 0] in all three: the sign test of a watertight
/// triangle.
template <size_t W> HWY_INLINE LaneMask same_side(const Lanes<W>& u, const Lanes<W>& v, const Lanes<W>& w) {
    const Lanes<W> zero(0.0f);
    return less_equal(zero, min(min(u, v), w)) | less_equal(max(max(u, v), w), zero);
}

using Lanes16 = Lanes<16>;
using Lanes8 = Lanes<8>;
using Lanes4 = Lanes<4>;

/// The shared formulas over sixteen lanes.
namespace wide {
using Float = Lanes16;
#define FN HWY_INLINE
#define EXACT
#include "shared/displace.h"
#undef FN
#undef EXACT
} // namespace wide

/// The same over the four channels of a texel.
namespace texel {
using Float = Lanes4;
#define FN HWY_INLINE
#define EXACT
#include "shared/displace.h"
#undef FN
#undef EXACT
} // namespace texel

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
