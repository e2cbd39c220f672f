// How far the mean of samples is from what it would be of infinitely many.
#pragma once

#include <cstdint>

namespace relief {

/// Variance of the mean of n independent samples from their sum and their sum of squares (unbiased); 0 for
/// fewer than two samples.
double variance_of_mean(double sum, double sum_of_squares, uint32_t n);

} // namespace relief
