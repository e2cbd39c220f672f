#include "film/sample_batches.h"

#include <algorithm>

#include "math/vec.h"

namespace relief {

namespace {

double square(const Vec3<double>& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

} // namespace

void SampleBatches::add(size_t pixel, const Vec3f& radiance, uint32_t count) {
    Sums& sums = pixels_[pixel];
    for (size_t k = 0; k < kSizes.size(); ++k) {
        sums.open[k] += Vec3<double>{radiance.x, radiance.y, radiance.z};
        if (count % kSizes[k] == 0) sums.squares[k] += square(sums.open[k]), sums.open[k] = {};
    }
}

void SampleBatches::join(size_t pixel, const SampleBatches& other, size_t other_pixel) {
    Sums& sums = pixels_[pixel];
    const Sums& added = other.pixels_[other_pixel];
    for (size_t k = 0; k < kSizes.size(); ++k)
        sums.open[k] = added.open[k], sums.squares[k] += added.squares[k];
}

void SampleBatches::clear(size_t first, size_t count) {
    std::fill_n(pixels_.begin() + ptrdiff_t(first), count, Sums{});
}

std::optional<double> SampleBatches::estimate_variance(size_t pixel, const double* sums,
                                                       uint32_t count) const {
    size_t k = kSizes.size();
    while (k > 0 && count / kSizes[k - 1] < kLeastCount) --k;
    if (k == 0) return std::nullopt;
    const Sums& batches = pixels_[pixel];
    const double size = kSizes[k - 1], n = count / kSizes[k - 1];
    const Vec3<double>& open = batches.open[k - 1];
    const Vec3<double> full{sums[0] - open.x, sums[1] - open.y, sums[2] - open.z};
    const double of_sum = std::max(0.0, batches.squares[k - 1] - square(full) / n) / (n - 1);
    return of_sum / (size * count); // over size^2 it is that of a batch's mean
}

double variance_of_mean(double sum, double sum_of_squares, uint32_t n) {
    if (n < 2) return 0;
    const double mean = sum / n;
    return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1);
}

} // namespace relief
