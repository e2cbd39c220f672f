// How many samples of a pixel fell on each of the mattes of a Cryptomatte layer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace relief {

/// A bounded number of slots a pixel. Where a pixel sees more mattes, a new one takes the slot with the
/// fewest samples, and those samples with it (Metwally, Agrawal and El Abbadi 2005, Space-Saving): the counts
/// go on to sum up to all samples that hit, and a matte with more than one in kSlots of them is never lost.
/// What comes out depends on the samples and their order alone.
class MatteCounts {
  public:
    /// The ranks of a picture, and some more: what is beyond them may turn out to be more than they are.
    static constexpr size_t kSlots = 8;
    struct Slot {
        uint32_t id = 0, samples = 0; ///< 0, 0: free
    };
    static constexpr size_t kPixelBytes = kSlots * sizeof(Slot);

    explicit MatteCounts(size_t pixel_count) : slots_(pixel_count * kSlots) {}

    /// `samples`: how many fell on it, one after another.
    void add(size_t pixel, uint32_t id, uint32_t samples = 1);
    /// Those of a pixel of other counts.
    void join(size_t pixel, const MatteCounts& other, size_t other_pixel);
    /// Pixels [first, first + count) have seen nothing.
    void clear(size_t first, size_t count);
    /// Writes 2 * kMatteRanks floats.
    void write_ranks(size_t pixel, uint32_t sample_count, float* target) const;

    std::vector<Slot>& slots() { return slots_; }
    const std::vector<Slot>& slots() const { return slots_; }

  private:
    std::vector<Slot> slots_; ///< kSlots a pixel, in use from the first on
};

} // namespace relief
