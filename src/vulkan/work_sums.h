// Sums of what was done: rays, pairs, trees, seconds.
#pragma once

#include <vector>

#include "relief/render.h"

namespace relief::vulkan {

/// Adds a cast to the one of its depth and kind, or in its place: by depth, shadow rays last.
void add_cast(std::vector<CastStatistics>& casts, const CastStatistics& cast);

/// Adds counts, stage times and casts; nothing about the scene, the device or memory.
void add_work(Statistics& sum, const Statistics& work);

} // namespace relief::vulkan
