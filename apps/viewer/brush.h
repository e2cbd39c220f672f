// Brushes, and rectangles of texels.
#pragma once

#include "relief/scene.h"

namespace relief::viewer {

enum class BrushKind { push, grab, smooth, erase };

struct Brush {
    BrushKind kind = BrushKind::push;
    float radius = 40;      ///< pixels of the picture, [1, 1000]
    float strength = 0.25f; ///< [-1, 1]: push: height of a dab as a share of a quarter of its radius;
                            ///< smooth and erase: part of the way there
    friend bool operator==(const Brush&, const Brush&) = default;
};

/// Half open rectangle of texels.
struct TexelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool is_empty() const { return x0 >= x1 || y0 >= y1; }
};

} // namespace relief::viewer
