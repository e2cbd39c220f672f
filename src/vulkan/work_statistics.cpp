#include "vulkan/work_statistics.h"

#include <algorithm>
#include <tuple>

namespace relief::vulkan {

void add_cast_work(CastStatistics& sum, const CastStatistics& work) {
    sum.pairs += work.pairs;
    sum.top_traversal_s += work.top_traversal_s, sum.sort_s += work.sort_s;
    sum.bottom_build_s += work.bottom_build_s, sum.bottom_traversal_s += work.bottom_traversal_s;
}

void add_cast(std::vector<CastStatistics>& casts, const CastStatistics& cast) {
    const auto key = [](const CastStatistics& c) { return std::tuple(c.depth, c.is_shadow); };
    auto place = std::lower_bound(casts.begin(), casts.end(), cast,
                                  [&](const auto& a, const auto& b) { return key(a) < key(b); });
    if (place == casts.end() || key(*place) != key(cast)) {
        casts.insert(place, cast);
        return;
    }
    place->rays += cast.rays;
    add_cast_work(*place, cast);
}

void add_work(Statistics& sum, const Statistics& work) {
    sum.top_traversal_s += work.top_traversal_s, sum.sort_s += work.sort_s;
    sum.bottom_build_s += work.bottom_build_s, sum.bottom_traversal_s += work.bottom_traversal_s;
    sum.shade_s += work.shade_s, sum.film_s += work.film_s;
    sum.camera_rays += work.camera_rays, sum.shadow_rays += work.shadow_rays;
    sum.bounce_rays += work.bounce_rays;
    sum.pairs_emitted += work.pairs_emitted, sum.pairs_with_hit += work.pairs_with_hit;
    sum.bottom_built += work.bottom_built, sum.bottom_reused += work.bottom_reused;
    sum.bottom_rebuilt += work.bottom_rebuilt;
    sum.bottom_levels.resize(std::max(sum.bottom_levels.size(), work.bottom_levels.size()));
    for (size_t level = 0; level < work.bottom_levels.size(); ++level)
        sum.bottom_levels[level] += work.bottom_levels[level];
    for (const CastStatistics& cast : work.casts) add_cast(sum.casts, cast);
}

} // namespace relief::vulkan
