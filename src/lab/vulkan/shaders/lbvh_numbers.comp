// From flags of cuts to their numbers.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"
#include "lab/vulkan/shaders/lbvh_scan.glsl"

layout(set = 0, binding = kBindBuildNumbers) buffer Numbers { uint numbers[]; };
layout(set = 0, binding = kBindBuildSums) readonly buffer Sums { uint sums[]; };

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    // Each lane has neighbours in memory, so that the order of lanes is that of entries.
    uint first = tile * kBuildTileSize + lane * kBuildItemCount;
    uint own = 0u;
    for (uint k = 0u; k < kBuildItemCount; ++k)
        if (first + k < push.primitive_count) own += numbers[first + k];
    uint number = scan_lanes(lane, own);
    if (first >= push.primitive_count) return;
    number += sums[tile];
    for (uint k = 0u; k < kBuildItemCount; ++k) {
        if (first + k >= push.primitive_count) break;
        uint flag = numbers[first + k];
        numbers[first + k] = number;
        number += flag;
    }
}
