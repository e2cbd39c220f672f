#include "math/extrema.h"

#include <algorithm>

#include "math/lane_targets.h"
#include "relief/half.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/extrema.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kChannels = 4;
constexpr size_t kMostLanes = 16;

/// Calls extend(values) for vectors of D that cover every row by whole texels; the last two may overlap.
template <class D, class Value, class Extend>
HWY_INLINE void visit_registers(D d, const TexelRows<Value>& texels, Extend extend) {
    const size_t count = kChannels * texels.columns, lanes = hn::Lanes(d);
    for (size_t y = 0; y < texels.rows; ++y) {
        const Value* row = texels.first + y * texels.stride;
        size_t k = 0;
        for (; k + lanes <= count; k += lanes) extend(row + k);
        if (k < count) extend(row + count - lanes);
    }
}

/// Reduces lanes to one of each channel.
template <class D, class V, class Reduce>
HWY_INLINE void join_lanes(D d, V values, Reduce reduce, hn::TFromD<D> (&joined)[kChannels]) {
    if constexpr (hn::MaxLanes(D()) > kChannels) {
        const hn::Half<D> half;
        join_lanes(half, reduce(hn::LowerHalf(half, values), hn::UpperHalf(half, values)), reduce, joined);
    } else {
        hn::StoreU(values, d, joined);
    }
}

template <class D, class V, class T = hn::TFromD<D>>
HWY_INLINE void join_lanes(D d, V low, V high, T (&least)[kChannels], T (&greatest)[kChannels]) {
    join_lanes(
        d, low, [](auto a, auto b) HWY_ATTR { return hn::Min(a, b); }, least);
    join_lanes(
        d, high, [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); }, greatest);
}

/// Maps the bits of halves to integers in the same order; an involution.
constexpr int16_t make_key(uint16_t half) { return int16_t(half ^ ((half & 0x8000u) != 0 ? 0x7fffu : 0u)); }

template <class D> Extrema join_halves(D d, const TexelRows<uint16_t>& texels) {
    constexpr int16_t kInfinity = make_key(0x7c00), kMinusInfinity = make_key(0xfc00);
    auto low = hn::Set(d, make_key(0x7fff)), high = hn::Set(d, make_key(0xffff));
    visit_registers(d, texels, [&](const uint16_t* values) {
        const auto half = hn::BitCast(d, hn::LoadU(hn::RebindToUnsigned<D>(), values));
        const auto key = hn::Xor(half, hn::And(hn::ShiftRight<15>(half), hn::Set(d, int16_t(0x7fff))));
        low = hn::Min(low, key), high = hn::Max(high, key);
    });
    int16_t least[kChannels], greatest[kChannels];
    join_lanes(d, low, high, least, greatest);
    Extrema result;
    result.is_finite = true;
    for (size_t c = 0; c < 3; ++c) {
        result.is_finite &= least[c] > kMinusInfinity && greatest[c] < kInfinity;
        result.low[c] = half_to_float(uint16_t(make_key(uint16_t(least[c]))));
        result.high[c] = half_to_float(uint16_t(make_key(uint16_t(greatest[c]))));
    }
    return result;
}

template <class D> Extrema join_floats(D d, const TexelRows<float>& texels) {
    auto low = hn::LoadU(d, texels.first), high = low;
    auto doubt = hn::Zero(d); // NaN after a NaN or infinity
    visit_registers(d, texels, [&](const float* values) {
        const auto value = hn::LoadU(d, values);
        low = hn::Min(low, value), high = hn::Max(high, value);
        doubt = hn::Add(doubt, hn::Sub(value, value));
    });
    float least[kChannels], greatest[kChannels];
    join_lanes(d, low, high, least, greatest);
    alignas(64) float doubts[kMostLanes];
    hn::Store(doubt, d, doubts);
    Extrema result;
    result.is_finite = true;
    for (size_t k = 0; k < hn::Lanes(d); ++k) result.is_finite &= k % kChannels == 3 || doubts[k] == 0;
    std::copy(least, least + 3, result.low.begin()), std::copy(greatest, greatest + 3, result.high.begin());
    return result;
}

Extrema find_half_extrema(const TexelRows<uint16_t>& texels) {
    const hn::CappedTag<int16_t, kMostLanes> wide;
    return kChannels * texels.columns >= hn::Lanes(wide)
               ? join_halves(wide, texels)
               : join_halves(hn::CappedTag<int16_t, kChannels>(), texels);
}

Extrema find_float_extrema(const TexelRows<float>& texels) {
    const hn::CappedTag<float, kMostLanes> wide;
    return kChannels * texels.columns >= hn::Lanes(wide)
               ? join_floats(wide, texels)
               : join_floats(hn::CappedTag<float, kChannels>(), texels);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace relief {

HWY_EXPORT(find_half_extrema);
HWY_EXPORT(find_float_extrema);

Extrema find_extrema(const TexelRows<uint16_t>& texels) {
    return HWY_DYNAMIC_DISPATCH(find_half_extrema)(texels);
}
Extrema find_extrema(const TexelRows<float>& texels) {
    return HWY_DYNAMIC_DISPATCH(find_float_extrema)(texels);
}

} // namespace relief

#endif
