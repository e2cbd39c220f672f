// End of a ray's round: commits nearer hits, advances the cursor, and stays active while candidates may be nearer.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/patch_tree.h"

layout(scalar, push_constant) uniform Push { CastPush push; };

/// The candidate of rank `rank` by (instance, patch).
CandidateData find_ranked(uint place, uint rank) {
    for (uint k = 0u; k < push.slots; ++k) {
        CandidateData candidate = candidates[place * push.slots + k];
        uint before = 0u;
        for (uint other = 0u; other < push.slots; ++other) {
            CandidateData o = candidates[place * push.slots + other];
            if (o.instance != kNone && (o.instance < candidate.instance ||
                                        (o.instance == candidate.instance && o.patch_index < candidate.patch_index)))
                ++before;
        }
        if (candidate.instance != kNone && before == rank) return candidate;
    }
    return candidates[place * push.slots];
}

void take_hit(uint ray_index, uint place) {
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
    CandidateData last = candidates[place * push.slots + push.slots - 1u];
    if (last.instance == kNone) return; // all candidates were offered
    HitData best = hits[ray_index];
    if (best.instance != kNone && (push.is_any != 0u || last.entry > best.t * kBoxSlack)) return;
    cursors[ray_index] = CursorData(last.entry, last.instance, last.tree);
    uint next = atomicAdd(counters.next_active_count, 1u);
    next_active_rays[next] = ray_index;
}
