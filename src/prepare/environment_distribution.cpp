#include "prepare/environment_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "formulas/bsdf.h"
#include "formulas/constants.h"
#include "formulas/environment_data.h"
#include "formulas/texture.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

constexpr uint32_t kMaxCellsX = 1024, kMaxCellsY = 512;

Vec3f read_color(const Texture& texture, uint32_t x, uint32_t y) {
    const std::array<float, 3> channels = read_texel(texture, x, y);
    return scalar::make_texture_color(texture.channel_count, {channels[0], channels[1], channels[2]});
}

/// Turns weights from values[1] on into cumulative probabilities; returns their sum. Dim cells beside a
/// bright one keep a share that floats can tell from 0: in a shadow they are all the light there is.
double accumulate(std::span<float> values) {
    constexpr double kLeastShare = 0.01; // of the mean weight
    double sum = 0;
    for (size_t i = 1; i < values.size(); ++i) sum += values[i];
    const double least = kLeastShare * sum / double(values.size() - 1);
    const auto raise = [least](float weight) { return weight > 0 ? std::max(double(weight), least) : 0.0; };
    double raised = 0;
    for (size_t i = 1; i < values.size(); ++i) raised += raise(values[i]);
    double running = 0;
    values[0] = 0;
    for (size_t i = 1; i < values.size(); ++i) {
        running += raise(values[i]);
        values[i] = sum > 0 ? float(running / raised) : float(i) / float(values.size() - 1);
    }
    values.back() = 1;
    return sum;
}

/// Integral of the filtered luminance over each texel of a row: positive wherever filtered radiance is.
std::vector<double> integrate_row(const Texture& texture, uint32_t row, const Vec3f& scale) {
    const uint32_t above = row > 0 ? row - 1 : 0, below = std::min(row + 1, texture.height - 1);
    std::vector<double> filtered(texture.width), result(texture.width);
    const auto brightness = [&](uint32_t x, uint32_t y) {
        const float value = scalar::luminance(read_color(texture, x, y) * scale);
        return std::isfinite(value) ? std::max(0.0, double(value)) : 0.0;
    };
    for (uint32_t x = 0; x < texture.width; ++x)
        filtered[x] = 0.125 * (brightness(x, above) + 6 * brightness(x, row) + brightness(x, below));
    for (uint32_t x = 0; x < texture.width; ++x) {
        const double left = filtered[(x + texture.width - 1) % texture.width];
        const double right = filtered[(x + 1) % texture.width];
        result[x] = 0.125 * (left + 6 * filtered[x] + right);
    }
    return result;
}

/// Part of `texel` of `texels` that lies in `cell` of `cells` along an axis; cells are at least as wide.
double compute_overlap(uint64_t texel, uint64_t texels, uint64_t cell, uint64_t cells) {
    const uint64_t low = std::max(texel * cells, cell * texels);
    const uint64_t high = std::min((texel + 1) * cells, (cell + 1) * texels);
    return high > low ? double(high - low) / double(cells) : 0.0;
}

/// Integrals of the cells of one row, from entry 1 on.
void integrate_cells(const Texture& texture, const Vec3f& scale, uint32_t cell_y, uint32_t cells_y,
                     std::span<float> cells) {
    const uint32_t cells_x = uint32_t(cells.size()) - 1;
    std::vector<double> sums(cells_x, 0.0);
    const uint32_t first = uint32_t(uint64_t(cell_y) * texture.height / cells_y);
    const uint32_t last = uint32_t((uint64_t(cell_y + 1) * texture.height + cells_y - 1) / cells_y);
    for (uint32_t y = first; y < last; ++y) {
        const double sine_integral = std::cos(std::numbers::pi * y / texture.height) -
                                     std::cos(std::numbers::pi * (y + 1) / texture.height);
        const double share_y = sine_integral * compute_overlap(y, texture.height, cell_y, cells_y);
        const std::vector<double> row = integrate_row(texture, y, scale);
        for (uint32_t x = 0; x < texture.width; ++x) {
            const uint32_t cell = uint32_t(uint64_t(x) * cells_x / texture.width);
            const double share = compute_overlap(x, texture.width, cell, cells_x);
            sums[cell] += row[x] * share_y * share;
            if (share < 1) sums[cell + 1] += row[x] * share_y * (1 - share);
        }
    }
    for (uint32_t x = 0; x < cells_x; ++x) cells[x + 1] = float(sums[x]);
}

} // namespace

EnvironmentDistribution make_environment_distribution(const Environment& environment) {
    EnvironmentDistribution result;
    const Vec3f scale = environment.color * environment.strength;
    if (!environment.texture) {
        result.mean_luminance = scalar::luminance(scale);
        return result;
    }
    const Texture& texture = *environment.texture;
    const uint32_t cells_x = std::min(texture.width, kMaxCellsX);
    const uint32_t cells_y = std::min(texture.height, kMaxCellsY);
    result.cells_x = cells_x, result.cells_y = cells_y;
    result.rows.assign(cells_y + 1, 0.0f);
    result.columns.assign(size_t(cells_y) * (cells_x + 1), 0.0f);
    parallel_for("environment_rows", cells_y, 1, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            const std::span<float> cells =
                std::span(result.columns).subspan(row * (cells_x + 1), cells_x + 1);
            integrate_cells(texture, scale, uint32_t(row), cells_y, cells);
            result.rows[row + 1] = float(accumulate(cells));
        }
    });
    // The sine integrals sum up to 2 over the rows.
    result.mean_luminance = float(accumulate(result.rows) / (2.0 * texture.width));
    return result;
}

scalar::EnvironmentData make_environment_data(const Environment& environment,
                                              const EnvironmentDistribution& distribution) {
    const double turn = environment.rotate_degrees * std::numbers::pi / 180;
    return {environment.color * environment.strength,
            float(std::sin(turn)),
            float(std::cos(turn)),
            distribution.cells_x,
            distribution.cells_y,
            scalar::kNone};
}

} // namespace relief
