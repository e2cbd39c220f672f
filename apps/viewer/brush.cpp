#include "viewer/brush.h"

#include <algorithm>
#include <cmath>

namespace relief::viewer {

namespace {

/// Texels from the corner of a map that any dab may reach.
constexpr float kMost = 1 << 20;

} // namespace

TexelBox find_reach(const Dab& dab) {
    // The ellipse |M t| <= r with M of the two columns reaches as far as the rows of its inverse say.
    const Vec2f &a = dab.pixels_right, &b = dab.pixels_down;
    const float determinant = std::fabs(a.x * b.y - a.y * b.x);
    if (!(determinant > 0)) return {};
    const float across = dab.radius * std::hypot(b.x, b.y) / determinant;
    const float down = dab.radius * std::hypot(a.x, a.y) / determinant;
    const auto cut = [](float value) { return int(std::clamp(value, -kMost, kMost)); };
    return {cut(std::floor(dab.centre.x - across)), cut(std::floor(dab.centre.y - down)),
            cut(std::ceil(dab.centre.x + across)), cut(std::ceil(dab.centre.y + down))};
}

float find_weight(const Dab& dab, float x, float y) {
    const float dx = x - dab.centre.x, dy = y - dab.centre.y;
    const float right = dab.pixels_right.x * dx + dab.pixels_down.x * dy;
    const float down = dab.pixels_right.y * dx + dab.pixels_down.y * dy;
    const float share = (right * right + down * down) / (dab.radius * dab.radius);
    return share < 1 ? (1 - share) * (1 - share) : 0;
}

} // namespace relief::viewer
