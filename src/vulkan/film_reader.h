// Brings the film's sums of a batch of pixels from the device into the film.
#pragma once

#include <span>

#include "film/film.h"
#include "vulkan/device/commands.h"
#include "vulkan/layout/device_paths.h"

namespace relief::vulkan {

/// What a launch leaves of its pixels beside their sums.
struct FilmBatch {
    std::span<const uint32_t> pixels; ///< pack_pixel()
    int sample_count = 0;
    std::span<const uint32_t> first_hits; ///< sample by sample, one a pixel; empty: not asked for
    std::span<const Vec3f> lights;        ///< as many a pixel as the film has layers of light
};

/// Where the sums of a batch are.
struct BatchSums {
    const Buffer* buffer;
    bool has_colors_alone = false; ///< FilmColorsData in place of FilmSumsData
};

/// Not thread safe.
class FilmReader {
  public:
    /// The device must outlive it.
    explicit FilmReader(const Device& device);

    /// Where `film` has use for colours alone, records what brings those of `count` pixels together in
    /// `scratch`, which is bound to kBindPoints and free. `sums` is bound to kBindFilm.
    BatchSums pack(Commands& commands, const Film& film, const Buffer& sums, const Buffer& scratch,
                   uint32_t count) const;

    static void add(Film& film, const BatchSums& sums, const FilmBatch& batch);

  private:
    Kernel film_colors_;
};

} // namespace relief::vulkan
