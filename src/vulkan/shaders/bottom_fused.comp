// Fused form (Harada 2015, algorithm 1): persistent groups build a tree with all lanes, then trace a ray a lane.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/bottom_build.glsl"
#include "vulkan/shaders/patch_traversal.glsl"

layout(constant_id = 5) const uint kMostPairs = 0xffffffffu; ///< pairs that a group traces per tree
layout(constant_id = 6) const uint kMostJobs = 0xffffffffu;  ///< jobs that a group takes

layout(scalar, push_constant) uniform Push { CastPush push; };

shared uint shared_job;

void work_on(const uint tree) {
    TreeRecord record = trees[tree];
    if (record.ready_wave != push.wave) return; // uniform over the group
    BuildJob job = make_build_job(tree, 0u, push.patch_count, push.pool_capacity);
    job.is_real = record.build_wave == push.wave;
    if (job.is_real) build_tree(job, gl_LocalInvocationID.x);
    wait_for_group();
    uint end = min(record.end - record.begin, kMostPairs) + record.begin;
    for (uint place = record.begin + gl_LocalInvocationID.x; place < end; place += kLanes)
        trace_pair(pairs[place], push);
}

void main() {
    for (uint taken = 0u; taken < kMostJobs; ++taken) {
        if (gl_LocalInvocationID.x == 0u) shared_job = atomicAdd(counters.next_job, 1u);
        wait_for_group();
        uint number = shared_job;
        wait_for_group();
        if (number >= counters.job_count) return;
        work_on(jobs[number]);
    }
}
