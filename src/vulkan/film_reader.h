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

/// Not thread safe.
class FilmReader {
  public:
    /// The device must outlive it.
    explicit FilmReader(const Device& device);

    /// Where `film` has use for colours alone, records what brings those of `count` pixels together in
    /// `scratch`, which is bound to kBindPoints and free.
    void pack(Commands& commands, const Film& film, const Buffer& scratch, uint32_t count);

    /// Adds a batch: what was packed last, or all of `sums`.
    void add(Film& film, const Buffer& sums, const FilmBatch& batch);

  private:
    Kernel film_colors_;
    const Buffer* packed_ = nullptr; ///< the scratch memory; null: nothing was packed
};

} // namespace relief::vulkan
