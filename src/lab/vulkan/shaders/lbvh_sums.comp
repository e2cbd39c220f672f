// From the cuts of each tile to those before it: one group walks over all tiles.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"
#include "lab/vulkan/shaders/lbvh_scan.glsl"

layout(set = 0, binding = kBindBuildNumbers) writeonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = kBindBuildSums) buffer Sums { uint sums[]; };

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint tile_count = (push.primitive_count + kBuildTileSize - 1u) / kBuildTileSize;
    uint total = 0u;
    for (uint first = 0u; first < tile_count; first += kBuildGroupSize) {
        uint tile = first + lane;
        uint own = tile < tile_count ? sums[tile] : 0u;
        uint before = scan_lanes(lane, own);
        if (tile < tile_count) sums[tile] = total + before;
        total += lane_sums[kBuildGroupSize - 1u];
    }
    if (lane > 0u) return;
    numbers[push.primitive_count] = total;
    state.cut_count = total;
}
