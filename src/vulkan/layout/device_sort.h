// Radix sort of pairs: four-bit digits, least significant first; see vulkan/radix_sort.h.
#ifndef RELIEF_DEVICE_SORT_H
#define RELIEF_DEVICE_SORT_H
#include "formulas/begin.h"

const uint kSortGroupSize = 256u;
const uint kSortItemCount = 8u; ///< per invocation
const uint kSortTileSize = 2048u;
const uint kSortDigitCount = 16u;

/// Push constants of one pass.
struct SortPush {
    uint counter_word; ///< word of kBindCounters with the number of pairs
    uint capacity;     ///< maximum number of pairs
    uint shift, mask;  ///< digit = key >> shift & mask
    uint is_back;      ///< from sorted pairs to pairs, else the reverse
};

#include "formulas/end.h"
#endif
