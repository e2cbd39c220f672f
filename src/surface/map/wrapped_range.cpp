#include "surface/map/wrapped_range.h"

#include <algorithm>

#include "surface/map/texels.h"

namespace relief {

WrappedRange wrap_range(int64_t first, int64_t last, int64_t size, WrapMode wrap) {
    WrappedRange result;
    if (wrap == WrapMode::clamp) {
        result.add(std::clamp<int64_t>(first, 0, size - 1), std::clamp<int64_t>(last, 0, size - 1));
        return result;
    }
    if (wrap == WrapMode::black) {
        result.is_outside_read = first < 0 || last >= size;
        if (last >= 0 && first < size) result.add(std::max<int64_t>(first, 0), std::min(last, size - 1));
        return result;
    }
    if (last - first >= size - 1) {
        result.add(0, size - 1);
        return result;
    }
    const int64_t a = wrap_index(first, size, wrap), b = wrap_index(last, size, wrap);
    if (wrap == WrapMode::repeat) {
        if (a <= b) {
            result.add(a, b);
        } else {
            result.add(a, size - 1);
            result.add(0, b);
        }
        return result;
    }
    // Mirrored: the range runs up, down, or turns once at either end.
    const auto find_period = [&](int64_t index) {
        return index >= 0 ? index / size : -((size - 1 - index) / size);
    };
    const int64_t period = find_period(first);
    if (period == find_period(last)) {
        result.add(std::min(a, b), std::max(a, b));
    } else if (period % 2 == 0) {
        result.add(std::min(a, b), size - 1);
    } else {
        result.add(0, std::max(a, b));
    }
    return result;
}

} // namespace relief
