#include "viewer/resolution_governor.h"

#include <algorithm>
#include <cmath>

namespace relief::viewer {

namespace {

/// One slow picture, say the first of a side that nobody has seen, says little of the next.
constexpr double kLeastStep = 0.7, kMostStep = 1.2;

} // namespace

std::pair<int, int> ResolutionGovernor::choose_size(int width, int height) const {
    const auto scaled = [&](int pixels) { return std::max(1, int(std::lround(scale_ * pixels))); };
    return {scaled(width), scaled(height)};
}

void ResolutionGovernor::learn(double seconds) {
    if (seconds <= 0) return;
    // Half of the way to where the time would be right if it grew with the number of pixels.
    const double step = std::pow(config_.target_s / seconds, 0.25);
    scale_ = std::clamp(scale_ * std::clamp(step, kLeastStep, kMostStep), config_.least_scale, 1.0);
}

} // namespace relief::viewer
