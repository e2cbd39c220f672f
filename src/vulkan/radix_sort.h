// Sorts pairs by their first word on the device. Stable, hence deterministic.
#pragma once

#include <cstdint>

#include "vulkan/device/commands.h"
#include "vulkan/device/device.h"
#include "vulkan/device/kernel.h"

namespace relief::vulkan {

/// Least significant digit first, four bits a pass (Satish et al. 2009). The device must outlive it.
class RadixSort {
  public:
    explicit RadixSort(const Device& device);

    /// Required words of the buffer at kBindHistogram to sort `capacity` pairs.
    uint64_t histogram_words(uint64_t capacity) const;

    /// Number of passes; each reads all pairs twice and writes them once.
    static uint32_t count_passes(uint32_t key_bits);

    /// Sorts counters[counter_word] pairs of kBindPairs, at most `capacity`, by the lowest `key_bits` of
    /// their first word (others 0), in place; overwrites kBindSortedPairs and kBindHistogram.
    void record(Commands& commands, uint64_t capacity, uint32_t key_bits, uint32_t counter_word) const;

  private:
    Kernel count_, scan_, scatter_;
};

} // namespace relief::vulkan
