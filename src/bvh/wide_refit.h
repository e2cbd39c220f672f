// Boxes of a wide tree after some of its primitives have moved: the tree keeps its shape.
#pragma once

#include <functional>
#include <span>

#include "bvh/wide_bvh.h"

namespace relief {

/// For trees whose leaves hold one primitive each. `is_moved` holds a byte a primitive; `find_box` gives the
/// box of a primitive as it is now and is called from several threads, also for some that have not moved.
/// Boxes of what has not moved may come out a little larger than before, but do not grow from call to call.
void refit_wide_bvh(WideBvh& tree, std::span<const uint8_t> is_moved,
                    const std::function<Box(uint32_t primitive)>& find_box);

} // namespace relief
