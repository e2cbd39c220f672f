// Split form, traversal kernel: one invocation per pair; after the fused form for trees with excess pairs.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/patch_traversal.glsl"

layout(constant_id = 5) const uint kFirstPair = 0; ///< per tree: earlier pairs have been traced already

layout(scalar, push_constant) uniform Push { CastPush push; };

void main() {
    uint place = invocation_index();
    if (place >= counters.pair_count) return;
    uvec2 pair = pairs[place];
    TreeRecord record = trees[pair.x];
    if (record.ready_wave == push.wave && place - record.begin >= kFirstPair) trace_pair(pair, push);
}
