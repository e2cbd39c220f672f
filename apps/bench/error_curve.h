// Error of pictures against a reference, and the time that a renderer needs for a given error.
#pragma once

#include <optional>
#include <span>

#include "relief/image.h"

namespace relief::bench {

/// Mean over pixels and R, G, B of (picture - reference)^2 / (reference^2 + 0.01), as Rousselle et al. 2011
/// (section 6) measure it. Both have these channels and the same size, or Error{failed} is thrown.
double compute_relative_error(const Image& picture, const Image& reference);

/// A picture of a series with growing numbers of samples.
struct ErrorPoint {
    int samples = 0;
    double seconds = 0, error = 0;
};

/// Seconds until the error is `error`, interpolated in logarithms between two points of `curve`, which has
/// more samples from point to point. Before the first point it is that point's: a picture of fewer samples
/// does not exist. Nothing where no point is that good.
std::optional<double> find_seconds(std::span<const ErrorPoint> curve, double error);

} // namespace relief::bench
