// Boxes of one level of a heap, from the level below.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildNodes) buffer Nodes { uvec4 nodes[]; };

NodeBox load_box(const uint key) {
    return NodeBox(uintBitsToFloat(nodes[2u * key].xyz), uintBitsToFloat(nodes[2u * key + 1u].xyz));
}

void main() {
    uint key_count = 1u << push.level;
    uint invocation = invocation_index();
    if (invocation >= key_count) return;
    uint key = key_count + invocation;
    uint first = nodes[2u * key].w;
    uint word = nodes[2u * key + 1u].w;
    if (word == kEmptySlot) return;
    NodeBox box;
    if (is_leaf_word(word)) {
        box = join_primitives(first, get_word_count(word));
        if (state.depth < push.level) atomicMax(state.depth, push.level);
    } else {
        box = join_boxes(load_box(2u * key), load_box(2u * key + 1u));
    }
    nodes[2u * key] = uvec4(floatBitsToUint(box.lower), first);
    nodes[2u * key + 1u] = uvec4(floatBitsToUint(box.upper), word);
}
