#include "samples/plates.h"

#include <algorithm>

#include "samples/noise.h"

namespace relief::samples {

namespace {

int wrap(int i, int period) { return ((i % period) + period) % period; }

uint32_t cell_seed(const PlateField& field, int x, int y) {
    return hash(wrap(x, field.columns), wrap(y, field.rows), 0, field.seed);
}

Vec2f cell_point(const PlateField& field, int x, int y) {
    const uint32_t seed = cell_seed(field, x, y);
    const float jx = to_unit(seed * 0x9e3779b1u), jy = to_unit(seed * 0x85ebca77u);
    // Every other column is moved by half a cell, as bricks are, so that cracks do not run straight across.
    const float shift = x % 2 == 0 ? 0.0f : 0.5f;
    return {float(x) + 0.5f + field.jitter * (jx - 0.5f),
            float(y) + shift + 0.5f + field.jitter * (jy - 0.5f)};
}

} // namespace

PlateHit find_plate(const PlateField& field, const Vec2f& uv) {
    const Vec2f p{uv.x * float(field.columns), uv.y * float(field.rows)};
    const int x0 = int(std::floor(p.x)), y0 = int(std::floor(p.y));
    int near_x = x0, near_y = y0;
    float best = 1e30f;
    for (int y = y0 - 2; y <= y0 + 1; ++y)
        for (int x = x0 - 1; x <= x0 + 1; ++x) {
            const Vec2f d = cell_point(field, x, y) - p;
            const float squared = d.x * d.x + d.y * d.y;
            if (squared < best) best = squared, near_x = x, near_y = y;
        }
    const Vec2f own = cell_point(field, near_x, near_y);
    PlateHit hit;
    hit.seed = cell_seed(field, near_x, near_y);
    float weights = 0;
    Vec2f inward;
    for (int y = near_y - 2; y <= near_y + 2; ++y)
        for (int x = near_x - 2; x <= near_x + 2; ++x) {
            if (x == near_x && y == near_y) continue;
            const Vec2f other = cell_point(field, x, y), step = other - own;
            const float step_length = length(step);
            const Vec2f axis = step * (1 / step_length), middle = (own + other) * 0.5f;
            const float lattice = (middle.x - p.x) * axis.x + (middle.y - p.y) * axis.y;
            // The bisector's distance in tile units: the lattice is stretched by columns and rows.
            const Vec2f stretched{axis.x * float(field.columns), axis.y * float(field.rows)};
            const float stretch = length(stretched);
            const float weight = std::exp(-lattice / (stretch * field.rounding));
            weights += weight;
            inward = inward - stretched * (weight / stretch);
        }
    // Borders that melt together lie a little outside of the true ones; at a crack's middle the distance is
    // 0.
    hit.distance = std::max(0.0f, -field.rounding * std::log(weights));
    hit.inward = inward * (1 / weights);
    return hit;
}

} // namespace relief::samples
