// Least and greatest values of many texels, four to sixteen numbers at a time, as the machine has registers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace relief {

/// columns x rows texels of four channels; `stride` values from row to row.
template <class Value> struct TexelRows {
    const Value* first;
    size_t stride, columns, rows; ///< neither columns nor rows is 0
};

/// Of the first three channels.
struct Extrema {
    std::array<float, 3> low, high;
    bool is_finite; ///< else one of the values is NaN or infinite, and the others are of no use
};

/// Of halves, given by their bits.
Extrema find_extrema(const TexelRows<uint16_t>& texels);
Extrema find_extrema(const TexelRows<float>& texels);

} // namespace relief
