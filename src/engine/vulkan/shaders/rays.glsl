// Rays, hits, and what passes between the stages of a cast.
#ifndef RELIEF_RAYS_GLSL
#define RELIEF_RAYS_GLSL

#include "engine/vulkan/shaders/scene.glsl"
#include "shared/object_ray.h"
#include "shared/quantise.h"
#include "shared/device_rays.h"

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

ObjectRay enter_object(RayData ray, InstanceData instance) {
    return make_object_ray(transform_point(instance.object_from_world, ray.origin),
                           transform_vector(instance.object_from_world, ray.direction));
}

uint64_t make_nearest(float t, uint rank) { return uint64_t(order_float(t)) << 32 | uint64_t(rank); }
float nearest_distance(uint64_t packed_hit) { return unorder_float(uint(packed_hit >> 32)); }

#endif
