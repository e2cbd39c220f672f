// The split form of the bottom level, second half: one invocation a pair. After the fused form it takes the pairs
// that a group leaves when a tree has very many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/patch_traversal.glsl"

layout(constant_id = 5) const uint kFirstPair = 0; ///< of each tree: those before are traced already

layout(scalar, push_constant) uniform Push { CastPush push; };

void main() {
    uint place = invocation_index();
    if (place >= counters.pair_count) return;
    uvec2 pair = pairs[place];
    TreeRecord record = trees[pair.x];
    if (record.ready_wave == push.wave && place - record.begin >= kFirstPair) trace_pair(pair, push);
}
