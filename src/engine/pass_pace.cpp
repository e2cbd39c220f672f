#include "engine/pass_pace.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// Of the time of the first step, the share that a later one may need: the first builds trees besides.
constexpr double kShareOfFirst = 0.25;
/// Of the time that is left, the share that a step of several samples may take: it may be slower than the
/// last one.
constexpr double kShareOfRest = 0.5;
/// Steps for a spectator add this share of the samples that there are, or more: fewer are slower to trace,
/// and a picture from the middle of such a step shows no difference.
constexpr int kLeastGrowth = 4;

/// Seconds over seconds of one sample, as samples from 1 to `most`.
int count_samples(double seconds, double sample_s, int most) {
    return seconds >= sample_s * most ? most : std::max(1, int(seconds / sample_s));
}

} // namespace

void PassPace::learn(uint64_t pixel_samples, double seconds, bool is_first) {
    if (pixel_samples == 0) return;
    rate_s_ = std::max(seconds, 1e-9) / double(pixel_samples);
    is_first_rate_ = is_first;
}

/// Steps of about equal length.
int PassPace::choose_watched_count(const PassRest& rest, double sample_s) const {
    const int full = rest.end - rest.begin;
    const int least = std::max(1, rest.begin / kLeastGrowth);
    const int most = std::max(count_samples(config_.longest_step_s, sample_s, full), std::min(least, full));
    const int steps = (full + most - 1) / most;
    return (full + steps - 1) / steps;
}

std::optional<int> PassPace::choose_count(const PassRest& rest, double left_s) const {
    const int full = rest.end - rest.begin;
    const bool is_limited = !std::isinf(left_s);
    if (rest.begin == 0) return is_limited ? 1 : full;
    if (is_limited && left_s <= 0) return std::nullopt;
    if (rate_s_ == 0) return is_limited ? 1 : full;
    const double sample_s = rate_s_ * double(rest.pixels);
    const int count = config_.keeps_bits ? choose_watched_count(rest, sample_s) : full;
    if (!is_limited) return count;
    if (sample_s * (is_first_rate_ ? kShareOfFirst : 1) > left_s) return std::nullopt;
    const bool is_late = rate_s_ * double(rest.pixel_samples_ahead) > left_s;
    if (!is_late && !config_.keeps_bits) return count;
    return std::min(count, count_samples(kShareOfRest * left_s, sample_s, full));
}

} // namespace relief
