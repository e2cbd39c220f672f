// The error of the pixels of a film, by which a plan of samples finds what is still noisy. Owen-scrambled
// samples are closer to their mean than independent ones: of a pixel's samples each 16 that follow each
// other, a net of their own, are one draw, and the means of these batches tell the error. After batch means
// in the analysis of simulations (Conway 1963).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "film/error_of_mean.h"
#include "film/film.h"
#include "math/vec.h"

namespace relief {

namespace {

/// Radiance whose noise counts half: in the dark no relative error is ever small.
constexpr double kDarkest = 0.01;
constexpr uint32_t kBatchSamples = 16;
/// Fewer say less of the variance than the samples in them do.
constexpr uint32_t kLeastBatches = 4;

} // namespace

double variance_of_mean(double sum, double sum_of_squares, uint32_t n) {
    if (n < 2) return 0;
    const double mean = sum / n;
    return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1);
}

/// After samples were added, which do not reach across the end of a batch (engine/sample_plan.h).
void Film::close_batch(size_t pixel) {
    if (counts_[pixel] % kBatchSamples != 0) return;
    const double* radiance = sums_.data() + pixel * stride_;
    double* batches = sums_.data() + pixel * stride_ + *batches_offset_;
    for (size_t c = 0; c < 3; ++c) {
        const double sum = radiance[c] - batches[c];
        batches[3 + c] += sum * sum;
        batches[c] = radiance[c];
    }
}

/// Of the mean of a pixel's samples.
Vec3<double> Film::estimate_variance(size_t pixel) const {
    const double* radiance = sums_.data() + pixel * stride_;
    const uint32_t samples = counts_[pixel], count = samples / kBatchSamples;
    const bool has_batches = count >= kLeastBatches;
    const double* sums = has_batches ? radiance + *batches_offset_ : radiance;
    const double* squares = has_batches ? sums + 3 : radiance + *squares_offset_;
    // Of the sums of batches it is kBatchSamples^2 times that of their means.
    const double scale = has_batches ? double(count) / (double(kBatchSamples) * double(samples)) : 1.0;
    const uint32_t n = has_batches ? count : samples;
    return {scale * variance_of_mean(sums[0], squares[0], n),
            scale * variance_of_mean(sums[1], squares[1], n),
            scale * variance_of_mean(sums[2], squares[2], n)};
}

double Film::estimate_error(const Window& window) const {
    DCHECK(squares_offset_ && batches_offset_);
    double sum = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const size_t pixel = pixel_index(x, y);
            const uint32_t n = counts_[pixel];
            if (n < 2) return std::numeric_limits<double>::infinity();
            const Vec3<double> variances = estimate_variance(pixel);
            const double* radiance = sums_.data() + pixel * stride_;
            const double variance = (variances.x + variances.y + variances.z) / 3;
            const double mean = (radiance[0] + radiance[1] + radiance[2]) / n / 3;
            sum += variance / ((mean + kDarkest) * (mean + kDarkest));
        }
    return std::sqrt(sum / (double(window.x1 - window.x0) * double(window.y1 - window.y0)));
}

} // namespace relief
