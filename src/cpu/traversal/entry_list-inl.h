// Children that a ray is to visit, sorted by the distance at which it enters them.
#pragma once

#include <cstring>

#include "formulas/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Entries of children that a ray is to visit: the entry distance with its last bits replaced by the child,
/// so that whole numbers in rising order are distances in rising order (from t >= 0; below, any order will
/// do). Up to kCapacity children, a power of two.
template <uint32_t kCapacity> struct EntryList {
    static constexpr uint32_t kChildMask = kCapacity - 1;
    alignas(64) uint32_t key[kCapacity + 16]; ///< a little more than fits: whole registers are stored
    uint32_t count = 0;

    /// Appends the lanes of `mask` as children first, first + 1...; `first` is a multiple of W.
    template <size_t W> RELIEF_INLINE void append(LaneMask mask, const Lanes<W>& entry, uint32_t first) {
        // Read from memory: compilers make a mess of a vector that counts up from a variable.
        alignas(64) static constexpr uint32_t kNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                              8, 9, 10, 11, 12, 13, 14, 15};
        const hn::RebindToUnsigned<typename Lanes<W>::D> d;
        constexpr size_t kLanes = Lanes<W>::kLanes;
        for (size_t p = 0; p < Lanes<W>::kParts; ++p) {
            const auto distance = hn::AndNot(hn::Set(d, kChildMask), hn::BitCast(d, entry.part[p]));
            const auto child = hn::Or(hn::Set(d, first), hn::Load(d, kNumbers + p * kLanes));
            const LaneMask part = mask >> (p * kLanes);
            store_compressed(d, hn::Or(distance, child), part, key + count);
            count += uint32_t(__builtin_popcount(part & ((1u << kLanes) - 1)));
        }
    }

    RELIEF_INLINE void sort() {
        for (uint32_t k = 1; k < count; ++k) {
            const uint32_t next = key[k];
            uint32_t slot = k;
            for (; slot > 0 && key[slot - 1] > next; --slot) key[slot] = key[slot - 1];
            key[slot] = next;
        }
    }

    uint32_t child(uint32_t k) const { return key[k] & kChildMask; }
    /// Not above the entry distance (from t >= 0).
    float distance(uint32_t k) const {
        const uint32_t bits = key[k] & ~kChildMask;
        float result;
        std::memcpy(&result, &bits, sizeof(result));
        return result;
    }
};

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
