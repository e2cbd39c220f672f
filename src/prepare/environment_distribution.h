// How bright the environment is in each direction: what every engine draws directions from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formulas/environment_data.h"
#include "relief/scene.h"

namespace relief {

/// Piecewise constant density over cells of latitude and longitude: luminance times sin(theta).
struct EnvironmentDistribution {
    uint32_t cells_x = 0, cells_y = 0; ///< 0 without an image: all directions alike
    std::vector<float> rows;           ///< cells_y + 1 cumulative probabilities
    std::vector<float> columns;        ///< cells_x + 1 cumulative probabilities a row
    float mean_luminance = 0;          ///< over all directions

    std::span<const float> row(uint32_t index) const {
        return std::span(columns).subspan(size_t(index) * (cells_x + 1), cells_x + 1);
    }
};

/// Runs in parallel over the rows of the image.
EnvironmentDistribution make_environment_distribution(const Environment& environment);

/// What the formulas of formulas/environment.h take; `texture_index` is kNone.
scalar::EnvironmentData make_environment_data(const Environment& environment,
                                              const EnvironmentDistribution& distribution);

} // namespace relief
