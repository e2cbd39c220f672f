// One job: finds its tree in the ring buffer; if missing, too coarse or to be overwritten, allocates. Else defers.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/patch_tree.h"

layout(scalar, push_constant) uniform Push { CastPush push; };

const uint kLevelBits = 63u;

bool is_alive(const TreeRecord record) {
    if (push.is_cached == 0u || record.coverage == 0u) return false;
    return push.pool_start + push.pool_budget - record.address <= push.pool_capacity;
}

bool does_cover(const uint coverage, const uint need) {
    if (findMSB(coverage & kLevelBits) < findMSB(need & kLevelBits)) return false;
    return (need & ~coverage & ~kLevelBits) == 0u;
}

/// Allocates `units` contiguous units; kNone: no room left in this wave.
uint allocate(const uint units) {
    for (uint attempt = 0u; attempt < 4u; ++attempt) {
        uint address = atomicAdd(counters.pool_head, units);
        if (address + units - push.pool_start > push.pool_budget) return kNone;
        if (address % push.pool_capacity + units <= push.pool_capacity) return address;
    }
    return kNone;
}

void main() {
    uint place = invocation_index();
    if (place >= counters.job_count) return;
    uint tree = jobs[place];
    TreeRecord record = trees[tree];
    if (record.need == 0u) return;
    bool is_kept = is_alive(record);
    if (is_kept && does_cover(record.coverage, record.need)) {
        COUNT(counters.reused);
    } else {
        uint coverage = record.need | (is_kept ? record.coverage : 0u);
        uint level = uint(findMSB(coverage & kLevelBits));
        uint address = allocate(count_tree_units(level));
        if (address == kNone) {
            COUNT(counters.deferred_count);
            return;
        }
        trees[tree].coverage = coverage;
        trees[tree].address = address;
        trees[tree].build_wave = push.wave;
        uint bin = level <= 1u ? 0u : level <= 3u ? 1u : 2u;
        builds[bin * push.builds_stride + atomicAdd(counters.build_count[bin], 1u)] = tree;
        atomicAdd(counters.built[level], 1u);
    }
    trees[tree].need = 0u;
    trees[tree].ready_wave = push.wave;
    COUNT(counters.jobs_done);
}
