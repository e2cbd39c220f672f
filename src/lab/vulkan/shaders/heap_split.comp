// The heap of Murguia et al. 2013, from the top: nodes of one level are cut, or stay leaves. Slots without a node are
// written too, so that nothing of an earlier build is left.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildNodes) buffer Nodes { uvec4 nodes[]; };
layout(set = 0, binding = kBindBuildIds) writeonly buffer Ids { uint ids[]; };

/// `word`: number of entries from `first` on, or kEmptySlot.
void write_range(const uint key, const uint first, const uint word) {
    nodes[2u * key] = uvec4(0u, 0u, 0u, first);
    nodes[2u * key + 1u] = uvec4(0u, 0u, 0u, word);
}

void main() {
    uint invocation = invocation_index();
    if (push.level == 0u) {
        if (invocation == 0u) {
            write_range(0u, 0u, kEmptySlot);
            write_range(1u, 0u, push.primitive_count);
        }
        if (invocation < push.primitive_count) ids[invocation] = pairs[invocation].y;
        return;
    }
    uint parent_count = 1u << (push.level - 1u);
    if (invocation >= parent_count) return;
    uint parent = parent_count + invocation;
    uint first = nodes[2u * parent].w;
    uint word = nodes[2u * parent + 1u].w;
    uint last = first + word - 1u;
    if (word == kEmptySlot || is_equal(load_code(first), load_code(last))) {
        write_range(2u * parent, 0u, kEmptySlot);
        write_range(2u * parent + 1u, 0u, kEmptySlot);
        return;
    }
    Cut cut = cut_by_code(first, last);
    write_range(parent, 0u, make_inner_word(cut.axis));
    write_range(2u * parent, first, cut.entry - first);
    write_range(2u * parent + 1u, cut.entry, last + 1u - cut.entry);
}
