#include "vulkan/radix_sort.h"

#include <algorithm>

#include "base/check.h"
#include "formulas/constants.h"
#include "vulkan/layout/device_sort.h"

namespace relief::vulkan {
namespace {

using namespace scalar;

constexpr uint32_t kLargestDigitBits = 4;
static_assert(1u << kLargestDigitBits == kSortDigitCount);
static_assert(kSortTileSize == kSortGroupSize * kSortItemCount);

uint64_t count_tiles(uint64_t capacity) { return (capacity + kSortTileSize - 1) / kSortTileSize; }

} // namespace

RadixSort::RadixSort(const Device& device)
    : count_(device, {"sort_count", {kSortGroupSize}}),
      scan_(device, {"sort_scan", {kSortGroupSize}}),
      scatter_(device, {"sort_scatter", {kSortGroupSize}}) {}

uint64_t RadixSort::histogram_words(uint64_t capacity) const {
    return count_tiles(capacity) * kSortDigitCount;
}

uint32_t RadixSort::count_passes(uint32_t key_bits) {
    // Even, so that the result ends in the input buffer.
    return (key_bits + 2 * kLargestDigitBits - 1) / (2 * kLargestDigitBits) * 2;
}

void RadixSort::record(Commands& commands, uint64_t capacity, uint32_t key_bits,
                       uint32_t counter_word) const {
    DCHECK(key_bits <= 32 && capacity < kNone);
    const uint32_t passes = count_passes(key_bits);
    if (passes == 0 || capacity == 0) return;
    const uint32_t digit_bits = (key_bits + passes - 1) / passes;
    const uint64_t invocations = count_tiles(capacity) * kSortGroupSize;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        // With 1 key bit the second pass has no digit left and only copies the pairs back.
        const uint32_t shift = std::min(pass * digit_bits, key_bits);
        const uint32_t width = std::min(digit_bits, key_bits - shift);
        const SortPush push{counter_word, uint32_t(capacity), std::min(shift, 31u), (1u << width) - 1,
                            pass % 2};
        commands.dispatch(count_, invocations, push);
        commands.dispatch(scan_, kSortGroupSize, push);
        commands.dispatch(scatter_, invocations, push);
    }
}

} // namespace relief::vulkan
