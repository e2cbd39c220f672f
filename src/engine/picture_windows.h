// Windows of the picture cut into tiles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "relief/render.h"

namespace relief {

inline uint64_t count_pixels(const Window& window) {
    return uint64_t(window.x1 - window.x0) * uint64_t(window.y1 - window.y0);
}

/// Row by row, cut at absolute multiples of the edge so that crops trace the same packets.
inline std::vector<Window> cut_into_windows(const Window& window, int edge) {
    std::vector<Window> windows;
    for (int y = window.y0 / edge * edge; y < window.y1; y += edge)
        for (int x = window.x0 / edge * edge; x < window.x1; x += edge)
            windows.push_back({std::max(x, window.x0), std::max(y, window.y0), std::min(x + edge, window.x1),
                               std::min(y + edge, window.y1)});
    return windows;
}

} // namespace relief
