// Brings the film's sums of a batch of pixels from the device into the film.
#pragma once

#include <span>
#include <vector>

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
    /// `capacity`: most pixels of a batch. The device must outlive it.
    FilmReader(const Device& device, uint32_t capacity);

    /// Records the way of the sums of `count` pixels to the host. What `film` has no use for stays on a
    /// device that does not share the host's memory. `scratch` is bound to kBindPoints and free.
    void fetch(Commands& commands, const Film& film, const Buffer& sums, const Buffer& scratch,
               uint32_t count);

    /// Adds a batch whose sums were fetched; those of a CPU device are read from `sums`.
    void add(Film& film, const Buffer& sums, const FilmBatch& batch);

  private:
    scalar::FilmSumsData read_sums(size_t pixel) const;

    const Device& device_;
    uint32_t capacity_;
    Kernel film_colors_;
    Buffer on_host_;                              ///< of devices with memory of their own
    std::span<const scalar::FilmSumsData> whole_; ///< of the batch
    std::span<const scalar::FilmColorsData> colors_;
    std::vector<scalar::FilmSumsData> downloaded_;
};

} // namespace relief::vulkan
