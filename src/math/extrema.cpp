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

constexpr size_t kMostLanes = 16;

/// Texels that fill vectors of D, one after another: the channel of each of their lanes is always the same.
template <class D, size_t channels> struct Vectors {
    static constexpr size_t kCount = channels == 3 ? 3 : 1;
    static constexpr size_t kLanes = hn::MaxLanes(D());
    static constexpr size_t kValues = kCount * kLanes;
    static_assert(kValues % channels == 0);
};

/// Calls extend(values) for values of whole vectors that cover every row; the last two may overlap.
template <size_t value_count, class Value, class Extend>
HWY_INLINE void visit_values(const TexelRows<Value>& texels, Extend extend) {
    const size_t count = texels.channels * texels.columns;
    for (size_t y = 0; y < texels.rows; ++y) {
        const Value* row = texels.first + y * texels.row_stride;
        size_t k = 0;
        for (; k + value_count <= count; k += value_count) extend(row + k);
        if (k < count) extend(row + count - value_count);
    }
}

/// Maps the bits of halves to integers in the same order; an involution.
constexpr int16_t make_key(uint16_t half) { return int16_t(half ^ ((half & 0x8000u) != 0 ? 0x7fffu : 0u)); }

template <size_t channels, class D> Extrema join_halves(D d, const TexelRows<uint16_t>& texels) {
    using V = Vectors<D, channels>;
    constexpr int16_t kInfinity = make_key(0x7c00), kMinusInfinity = make_key(0xfc00);
    hn::Vec<D> low[V::kCount], high[V::kCount];
    for (size_t k = 0; k < V::kCount; ++k)
        low[k] = hn::Set(d, make_key(0x7fff)), high[k] = hn::Set(d, make_key(0xffff));
    visit_values<V::kValues>(texels, [&](const uint16_t* values) HWY_ATTR {
        for (size_t k = 0; k < V::kCount; ++k) {
            const auto half = hn::BitCast(d, hn::LoadU(hn::RebindToUnsigned<D>(), values + k * V::kLanes));
            const auto key = hn::Xor(half, hn::And(hn::ShiftRight<15>(half), hn::Set(d, int16_t(0x7fff))));
            low[k] = hn::Min(low[k], key), high[k] = hn::Max(high[k], key);
        }
    });
    int16_t least[V::kValues], greatest[V::kValues];
    for (size_t k = 0; k < V::kCount; ++k)
        hn::StoreU(low[k], d, least + k * V::kLanes), hn::StoreU(high[k], d, greatest + k * V::kLanes);
    Extrema result{{}, {}, true};
    for (size_t c = 0; c < std::min<size_t>(channels, 3); ++c) {
        for (size_t k = c + channels; k < V::kValues; k += channels)
            least[c] = std::min(least[c], least[k]), greatest[c] = std::max(greatest[c], greatest[k]);
        result.is_finite &= least[c] > kMinusInfinity && greatest[c] < kInfinity;
        result.low[c] = half_to_float(uint16_t(make_key(uint16_t(least[c]))));
        result.high[c] = half_to_float(uint16_t(make_key(uint16_t(greatest[c]))));
    }
    return result;
}

template <size_t channels, class D> Extrema join_floats(D d, const TexelRows<float>& texels) {
    using V = Vectors<D, channels>;
    hn::Vec<D> low[V::kCount], high[V::kCount], doubt[V::kCount]; // NaN after a NaN or infinity
    for (size_t k = 0; k < V::kCount; ++k)
        low[k] = high[k] = hn::LoadU(d, texels.first + k * V::kLanes), doubt[k] = hn::Zero(d);
    visit_values<V::kValues>(texels, [&](const float* values) HWY_ATTR {
        for (size_t k = 0; k < V::kCount; ++k) {
            const auto value = hn::LoadU(d, values + k * V::kLanes);
            low[k] = hn::Min(low[k], value), high[k] = hn::Max(high[k], value);
            doubt[k] = hn::Add(doubt[k], hn::Sub(value, value));
        }
    });
    float least[V::kValues], greatest[V::kValues], doubts[V::kValues];
    for (size_t k = 0; k < V::kCount; ++k) {
        hn::StoreU(low[k], d, least + k * V::kLanes), hn::StoreU(high[k], d, greatest + k * V::kLanes);
        hn::StoreU(doubt[k], d, doubts + k * V::kLanes);
    }
    Extrema result{{}, {}, true};
    for (size_t c = 0; c < std::min<size_t>(channels, 3); ++c)
        for (size_t k = c; k < V::kValues; k += channels) {
            result.is_finite &= doubts[k] == 0;
            result.low[c] = k == c ? least[k] : std::min(result.low[c], least[k]);
            result.high[c] = k == c ? greatest[k] : std::max(result.high[c], greatest[k]);
        }
    return result;
}

template <size_t channels, class D> Extrema join_vectors(D d, const TexelRows<uint16_t>& texels) {
    return join_halves<channels>(d, texels);
}
template <size_t channels, class D> Extrema join_vectors(D d, const TexelRows<float>& texels) {
    return join_floats<channels>(d, texels);
}

/// By the widest vectors that rows can fill.
template <size_t channels, class Lane, size_t lanes, class Value>
Extrema join_rows(const TexelRows<Value>& texels) {
    const hn::CappedTag<Lane, lanes> d;
    if constexpr (channels == 4 ? lanes > 4 : lanes > 1)
        if (channels * texels.columns < Vectors<decltype(d), channels>::kValues)
            return join_rows<channels, Lane, lanes / 2>(texels);
    return join_vectors<channels>(d, texels);
}

template <class Lane, class Value> Extrema join_texels(const TexelRows<Value>& texels) {
    if (texels.channels == 4) return join_rows<4, Lane, kMostLanes>(texels);
    return texels.channels == 3 ? join_rows<3, Lane, kMostLanes>(texels)
                                : join_rows<1, Lane, kMostLanes>(texels);
}

Extrema find_half_extrema(const TexelRows<uint16_t>& texels) { return join_texels<int16_t>(texels); }
Extrema find_float_extrema(const TexelRows<float>& texels) { return join_texels<float>(texels); }

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
