// Which texels of a map a range of columns or rows reads, wrap modes worked in.
#pragma once

#include <array>
#include <cstdint>

#include "relief/scene.h"

namespace relief {

/// Indices of one axis that a wrapped range reads: up to two ranges inside, perhaps the outside.
struct WrappedRange {
    std::array<std::array<int64_t, 2>, 2> parts{};
    int count = 0;
    bool is_outside_read = false;

    void add(int64_t first, int64_t last) { parts[count++] = {first, last}; }
};

/// Of the indices [first, last], any integers, of an axis of `size` texels.
WrappedRange wrap_range(int64_t first, int64_t last, int64_t size, WrapMode wrap);

} // namespace relief
