// Brushes: how a place of a map changes under one dab.
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

/// An ellipse of texels that is a disc in the picture.
struct Dab {
    Vec2f centre{};                  ///< texels, from the top left corner of the map
    Vec2f pixels_right, pixels_down; ///< pixels a texel to the right and downwards: columns of a matrix
    float radius = 1;                ///< pixels
};

/// Texels that the dab may reach, also beyond the map.
TexelBox find_reach(const Dab& dab);

/// 1 in the middle of the dab, 0 outside, without a kink.
float find_weight(const Dab& dab, float x, float y);

} // namespace relief::viewer
