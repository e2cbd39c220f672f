// Rays, hits, and intermediate results of a cast.
#ifndef RELIEF_RAYS_GLSL
#define RELIEF_RAYS_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/object_ray.h"
#include "formulas/quantise.h"
#include "vulkan/layout/device_rays.h"

layout(scalar, set = 0, binding = kBindRays) buffer Rays { RayData rays[]; };
layout(scalar, set = 0, binding = kBindHits) buffer Hits { HitData hits[]; };
layout(scalar, set = 0, binding = kBindActive) buffer Active { uint active_rays[]; };
layout(scalar, set = 0, binding = kBindNextActive) buffer NextActive { uint next_active_rays[]; };
layout(scalar, set = 0, binding = kBindCursors) buffer Cursors { CursorData cursors[]; };
layout(scalar, set = 0, binding = kBindCandidates) buffer Candidates { CandidateData candidates[]; };
layout(scalar, set = 0, binding = kBindPairs) buffer Pairs { uvec2 pairs[]; };
layout(scalar, set = 0, binding = kBindTrees) buffer Trees { TreeRecord trees[]; };
layout(scalar, set = 0, binding = kBindNearest) buffer Nearest { uint64_t nearest[]; };
layout(scalar, set = 0, binding = kBindCounters) buffer Counters { CounterData counters; };
layout(scalar, set = 0, binding = kBindJobs) buffer Jobs { uint jobs[]; };
layout(scalar, set = 0, binding = kBindBuilds) buffer Builds { uint builds[]; };

/// Adds one for each lane that does so together to a counter that very many lanes add to. (A fragment's helper lanes
/// write nothing, but may be elected.)
#ifdef FULL_SCREEN
#define COUNT(counter) atomicAdd(counter, 1u)
#else
#define COUNT(counter) \
    do { \
        uvec4 counted = subgroupBallot(true); \
        if (gl_SubgroupInvocationID == subgroupBallotFindLSB(counted)) \
            atomicAdd(counter, subgroupBallotBitCount(counted)); \
    } while (false)
#endif

ObjectRay enter_object(const RayData ray, const InstanceData instance) {
    LocalStart start = find_local_start(ray.origin, ray.direction, instance.origin, instance.world_from_object.t,
                                        instance.reach);
    ObjectRay result = make_object_ray(transform_point(instance.object_from_origin, start.origin),
                                       transform_vector(instance.object_from_origin, ray.direction));
    result.shift = start.shift;
    return result;
}

uint64_t make_nearest(const float t, const uint rank) { return uint64_t(order_float(t)) << 32 | uint64_t(rank); }
float nearest_distance(const uint64_t packed_hit) { return unorder_float(uint(packed_hit >> 32)); }

/// Ties go to the lower instance, then the lower patch, then the lower cell.
bool is_better(const HitData a, const HitData b) {
    if (b.instance == kNone || a.t != b.t) return b.instance == kNone || a.t < b.t;
    if (a.instance != b.instance) return a.instance < b.instance;
    if (a.patch_index != b.patch_index) return a.patch_index < b.patch_index;
    return a.cell < b.cell;
}

/// Position in a cell from weights (b, c) of its lower triangle 00 10 11 or its upper one 00 11 01.
vec2 place_in_cell(const vec2 weights, const uint is_upper) {
    return is_upper != 0u ? vec2(weights.x, weights.x + weights.y) : vec2(weights.x + weights.y, weights.y);
}

/// Position on a patch of `level` from the position in one of its cells.
vec2 place_on_patch(const uint cell, const uint level, const vec2 within) {
    precise float cell_size = 1.0 / float(1u << level);
    precise vec2 uv = (vec2(cell_column(cell), cell_row(cell)) + within) * cell_size;
    return uv;
}

#endif
