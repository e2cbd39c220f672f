#include "film/matte_counts.h"

#include <algorithm>
#include <array>
#include <span>

#include "image/cryptomatte.h"

namespace relief {

void MatteCounts::add(size_t pixel, uint32_t id, uint32_t samples) {
    const std::span<Slot> slots(&slots_[pixel * kSlots], kSlots);
    Slot* least = &slots.front();
    for (Slot& slot : slots) {
        if (slot.id == id || slot.id == 0) {
            slot = {id, slot.samples + samples};
            return;
        }
        if (slot.samples < least->samples) least = &slot;
    }
    *least = {id, least->samples + samples};
}

void MatteCounts::join(size_t pixel, const MatteCounts& other, size_t other_pixel) {
    for (const Slot& slot : std::span(&other.slots_[other_pixel * kSlots], kSlots))
        if (slot.samples > 0) add(pixel, slot.id, slot.samples);
}

void MatteCounts::clear(size_t first, size_t count) {
    std::fill_n(slots_.begin() + ptrdiff_t(first * kSlots), count * kSlots, Slot{});
}

void MatteCounts::write_ranks(size_t pixel, uint32_t sample_count, float* target) const {
    std::array<MatteShare, kSlots> shares;
    for (size_t k = 0; k < kSlots; ++k) {
        const Slot& slot = slots_[pixel * kSlots + k];
        shares[k] = {slot.id, double(slot.samples)};
    }
    write_matte_ranks(shares, sample_count, target);
}

} // namespace relief
