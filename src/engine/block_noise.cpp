#include "engine/block_noise.h"

namespace relief {

namespace {

/// Standard errors that ImageSettings::noise is compared with: 95 of 100 values of a normal distribution lie
/// within 1.96, so that 95 of 100 pixels of a block are closer than 1.25 times the noise to their mean.
constexpr double kDeviations = 1.96 / 1.25;

} // namespace

double estimate_block_noise(const Film& film, const Window& block) {
    return kDeviations * film.estimate_error(block);
}

} // namespace relief
