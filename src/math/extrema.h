// SIMD minimum and maximum of texels, four to sixteen values at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace relief {

/// columns x rows texels of `channels` values, which are 4, 3 or 1; rows are `row_stride` values apart.
template <class Value> struct TexelRows {
    const Value* first;
    size_t channels, row_stride, columns, rows; ///< columns and rows are > 0
};

/// Of the first three channels; those that texels do not have are 0.
struct Extrema {
    std::array<float, 3> low, high;
    bool is_finite; ///< false: a value is NaN or infinite, and the results are invalid
};

/// For halves, given as bits.
Extrema find_extrema(const TexelRows<uint16_t>& texels);
Extrema find_extrema(const TexelRows<float>& texels);

} // namespace relief
