// How far the mean of a pixel's samples is from what it would be of infinitely many, told from the means of
// batches of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "relief/types.h"

namespace relief {

/// Owen-scrambled samples are closer to their mean than independent ones. Those that follow each other are
/// stratified together: a batch of them is one draw, and its mean varies less than that of independent
/// samples. Batch means: Conway 1963, Some Tactical Problems in Digital Simulation.
class SampleBatches {
  public:
    static constexpr std::array<uint32_t, 2> kSizes{16, 64};
    /// Fewer say less of the variance than the samples in them do.
    static constexpr uint32_t kLeastCount = 4;
    struct Sums {
        std::array<Vec3<double>, kSizes.size()> open{}; ///< of the samples behind the last full batch
        std::array<double, kSizes.size()> squares{};    ///< of the sums of full batches, over all channels
    };

    explicit SampleBatches(size_t pixel_count) : pixels_(pixel_count) {}

    /// Samples that end no later than the next batch of the least size does; the pixel has `count` with them.
    void add(size_t pixel, const Vec3f& radiance, uint32_t count);
    /// Those of a pixel that follow; the ones before are a multiple of the greatest size.
    void join(size_t pixel, const SampleBatches& other, size_t other_pixel);
    /// Pixels [first, first + count) have no samples.
    void clear(size_t first, size_t count);
    /// Of the mean of a pixel's samples, summed over the channels, by the largest batches of which there are
    /// enough; nothing where of all there are too few. `sums`: of radiance, three.
    std::optional<double> estimate_variance(size_t pixel, const double* sums, uint32_t count) const;

    std::vector<Sums>& pixels() { return pixels_; }
    const std::vector<Sums>& pixels() const { return pixels_; }

  private:
    std::vector<Sums> pixels_;
};

/// Variance of the mean of n independent samples from their sum and their sum of squares (unbiased); 0 for
/// fewer than two.
double variance_of_mean(double sum, double sum_of_squares, uint32_t n);

} // namespace relief
