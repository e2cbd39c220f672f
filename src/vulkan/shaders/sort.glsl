// Shared declarations of the three kernels of a radix sort pass.
#include "formulas/lang.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_sort.h"

layout(local_size_x_id = 0) in; // kSortGroupSize
layout(binding = kBindPairs) buffer Pairs { uvec2 pairs[]; };
layout(binding = kBindSortedPairs) buffer SortedPairs { uvec2 sorted_pairs[]; };
layout(binding = kBindHistogram) buffer Histogram { uint histogram[]; };
layout(binding = kBindCounters) readonly buffer Counters { uint counters[]; };
layout(push_constant) uniform Push { SortPush push; };

uint count_pairs() { return min(counters[push.counter_word], push.capacity); }

uint count_tiles() { return (count_pairs() + kSortTileSize - 1u) / kSortTileSize; }

uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uvec2 load_pair(const uint i) { return push.is_back != 0u ? sorted_pairs[i] : pairs[i]; }

uint find_digit(const uvec2 pair) { return pair.x >> push.shift & push.mask; }
