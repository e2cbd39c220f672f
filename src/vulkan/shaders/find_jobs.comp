// Groups the sorted pairs into jobs: pairs per tree, the finest level of its rays and how much coarser edges are.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/patch_tree.h"

layout(scalar, push_constant) uniform Push { CastPush push; };

uint find_need(uint tree, CandidateData candidate) {
    if (tree >= push.patch_count) return 1u << kTreeLevels;
    uint field = push.is_ray_lod != 0u ? candidate.levels
                                       : find_levels(instances[candidate.instance], candidate.patch_index);
    return make_need(packed_patch_level(candidate.levels), field);
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
    uint need = find_need(tree, candidates[pairs[place].y]);
    if ((trees[tree].need & need) != need) atomicOr(trees[tree].need, need);
}
