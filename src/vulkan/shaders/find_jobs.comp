// Completes candidates, and groups the sorted pairs into jobs: pairs per tree, the finest level of its rays and how much
// coarser edges are.
#include "vulkan/shaders/kernel.glsl"
#include "formulas/patch_tree.h"
#include "vulkan/shaders/ray_levels.glsl"

uint find_need(const uint tree, const CandidateData candidate) {
    if (tree >= push.patch_count) return 1u << kTreeLevels;
    uint field = kHasRayLod != 0u && push.is_ray_lod != 0u
                     ? candidate.levels
                     : find_levels(instances[candidate.instance], candidate.patch_index);
    return make_need(packed_patch_level(candidate.levels), field);
}

/// Fills in what the walk of its ray had no registers for.
CandidateData complete_candidate(const uint place) {
    CandidateData candidate = candidates[place];
    if (candidate.tree >= push.patch_count) {
        TileRecord tile = tile_records[candidate.tree - push.patch_count];
        candidate.patch_index = tile.patch_index;
        candidate.levels = tile.levels;
    } else {
        uint ray_index = active_rays[push.first + place / push.slots];
        candidate.patch_index = candidate.tree - surfaces[instances[candidate.instance].surface].first_quad;
        candidate.levels = choose_levels(ray_index, candidate.instance, candidate.patch_index);
    }
    candidates[place].patch_index = candidate.patch_index;
    candidates[place].levels = candidate.levels;
    return candidate;
}

void main() {
    uint place = invocation_index();
    uint count = counters.pair_count;
    if (place >= count) return;
    uint tree = pairs[place].x;
    if (place == 0u || pairs[place - 1u].x != tree) {
        trees[tree].begin = place;
        uint job = atomicAdd(counters.job_count, 1u);
        jobs[job] = tree;
    }
    if (place + 1u == count || pairs[place + 1u].x != tree) trees[tree].end = place + 1u;
    uint need = find_need(tree, complete_candidate(pairs[place].y));
    if ((trees[tree].need & need) != need) atomicOr(trees[tree].need, need);
}
