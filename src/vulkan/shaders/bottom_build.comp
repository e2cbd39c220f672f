// Split form, build kernel: patch trees of one bin, one or several per work group.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/bottom_build.glsl"

layout(constant_id = 3) const uint kBin = 0;

layout(scalar, push_constant) uniform Push { CastPush push; };

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint place = gl_LocalInvocationID.x / kLanes;
    uint lane = gl_LocalInvocationID.x % kLanes;
    uint number = group * kJobs + place;
    BuildJob job;
    job.is_real = false;
    job.place = place;
    if (number < counters.build_count[kBin])
        job = make_build_job(builds[kBin * push.builds_stride + number], place, push.patch_count, push.pool_capacity);
    build_tree(job, lane);
}
