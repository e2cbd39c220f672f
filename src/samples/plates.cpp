#include "samples/plates.h"

#include <algorithm>

#include "base/check.h"
#include "samples/noise.h"

namespace relief::samples {

PlateField::PlateField(const Config& config) : config_(config) {
    DCHECK(config.columns >= 4 && config.rows >= 4 && config.columns % 2 == 0);
    for (int y = 0; y < config.rows; ++y)
        for (int x = 0; x < config.columns; ++x) {
            const uint32_t seed = hash(x, y, 0, config.seed);
            const float jx = to_unit(seed * 0x9e3779b1u), jy = to_unit(seed * 0x85ebca77u);
            // Every other column is moved by half a cell, as bricks are, so that no crack runs straight.
            const float shift = x % 2 == 0 ? 0.0f : 0.5f;
            cells_.push_back(
                {{0.5f + config.jitter * (jx - 0.5f), shift + 0.5f + config.jitter * (jy - 0.5f)}, seed});
        }
}

const PlateField::Cell& PlateField::cell(int x, int y) const {
    return cells_[size_t(wrap(y, config_.rows) * config_.columns + wrap(x, config_.columns))];
}

PlateHit PlateField::find(const Vec2f& uv) const {
    const Vec2f scale{float(config_.columns), float(config_.rows)}, p{uv.x * scale.x, uv.y * scale.y};
    const int x0 = int(std::floor(p.x)), y0 = int(std::floor(p.y));
    const auto point = [&](int x, int y) { return cell(x, y).offset + Vec2f{float(x), float(y)}; };
    int near_x = x0, near_y = y0;
    float best = 1e30f;
    for (int y = y0 - 2; y <= y0 + 1; ++y)
        for (int x = x0 - 1; x <= x0 + 1; ++x) {
            const Vec2f d = point(x, y) - p;
            const float squared = d.x * d.x + d.y * d.y;
            if (squared < best) best = squared, near_x = x, near_y = y;
        }
    const Vec2f own = point(near_x, near_y);
    PlateHit hit;
    hit.seed = cell(near_x, near_y).seed;
    float weights = 1e-30f;
    Vec2f inward;
    for (int y = near_y - 2; y <= near_y + 2; ++y)
        for (int x = near_x - 2; x <= near_x + 2; ++x) {
            const Vec2f other = point(x, y), step = other - own, middle = (own + other) * 0.5f;
            // The bisector's normal and distance in tile units: the lattice is stretched by columns and rows.
            const Vec2f stretched{step.x * scale.x, step.y * scale.y};
            const float stretch = std::max(length(stretched), 1e-20f);
            const float distance = ((middle.x - p.x) * step.x + (middle.y - p.y) * step.y) / stretch;
            if (distance > 16 * config_.rounding || (x == near_x && y == near_y)) continue;
            const float weight = std::exp(-distance / config_.rounding);
            weights += weight;
            inward = inward - stretched * (weight / stretch);
        }
    // Blended borders lie a little outside of the true ones; the middle of a crack has distance 0.
    hit.distance = std::max(0.0f, -config_.rounding * std::log(weights));
    hit.inward = inward * (1 / weights);
    return hit;
}

} // namespace relief::samples
