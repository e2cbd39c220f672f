// Accumulates statistics: rays, pairs, trees, seconds.
#pragma once

#include <vector>

#include "relief/render.h"

namespace relief::vulkan {

/// Adds all but the rays: of a further cast of the same ones.
void add_cast_work(CastStatistics& sum, const CastStatistics& work);

/// Adds a cast to the entry of its depth and kind, or inserts one; ordered by depth, shadow rays last.
void add_cast(std::vector<CastStatistics>& casts, const CastStatistics& cast);

/// Adds counts, stage times and casts, but nothing about scene, device or memory.
void add_work(Statistics& sum, const Statistics& work);

} // namespace relief::vulkan
