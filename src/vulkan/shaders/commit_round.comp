// End of a ray's round: commits nearer hits, advances the cursor, and stays active while candidates may be nearer.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/patch_tree.h"

layout(scalar, push_constant) uniform Push { CastPush push; };

/// The candidate of rank `rank` by (instance, patch). Those of a ray come first among its places.
CandidateData find_ranked(const uint place, const uint rank) {
    uint first = place * push.slots;
    uint count = 0u;
    while (count < push.slots && candidates[first + count].instance != kNone) ++count;
    for (uint k = 0u; k < count; ++k) {
        uint instance = candidates[first + k].instance;
        uint patch_index = candidates[first + k].patch_index;
        uint before = 0u;
        for (uint other = first; other < first + count; ++other) {
            uint other_instance = candidates[other].instance;
            if (other_instance < instance ||
                (other_instance == instance && candidates[other].patch_index < patch_index))
                ++before;
        }
        if (before == rank) return candidates[first + k];
    }
    return candidates[first];
}

void take_hit(const uint ray_index, const uint place) {
    uint64_t packed_hit = nearest[place];
    uint rank = uint(packed_hit);
    if (rank == 0xffffffffu) return;
    if (push.is_any != 0u) {
        hits[ray_index].instance = 0u;
        return;
    }
    CandidateData candidate = find_ranked(place, rank >> kCellBits);
    HitData found = HitData(nearest_distance(packed_hit), candidate.instance, candidate.patch_index, 0.0, 0.0,
                            rank & ((1u << kCellBits) - 1u), candidate.levels);
    if (is_better(found, hits[ray_index])) hits[ray_index] = found;
}

void main() {
    uint place = invocation_index();
    if (place >= push.count || counters.deferred_count > 0u) return;
    uint ray_index = active_rays[push.first + place];
    take_hit(ray_index, place);
    HitData best = hits[ray_index];
    if (best.instance != kNone && push.is_any != 0u) return;
    if (push.is_collecting != 0u) {
        CandidateData first = candidates[place * push.slots];
        if (first.instance != kNone || first.tree != kOverflown) return; // all candidates were offered
    } else {
        CandidateData last = candidates[place * push.slots + push.slots - 1u];
        if (last.instance == kNone) return; // all candidates were offered
        if (best.instance != kNone && last.entry > best.t * kBoxSlack) return;
        cursors[ray_index] = CursorData(last.entry, last.instance, last.tree);
    }
    uint next = atomicAdd(counters.next_active_count, 1u);
    next_active_rays[next] = ray_index;
}
