// Boxes from the leaves upwards: the invocation of the second child of a pair goes on with the parent, without waiting.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildNodes) coherent buffer Nodes { uvec4 nodes[]; };
layout(set = 0, binding = kBindBuildParents) readonly buffer Parents { uint parents[]; };
layout(set = 0, binding = kBindBuildArrivals) coherent buffer Arrivals { uint arrivals[]; };
layout(set = 0, binding = kBindBuildHeights) coherent buffer Heights { uint heights[]; };

void store_box(const uint node, const NodeBox box) {
    nodes[2u * node].xyz = floatBitsToUint(box.lower);
    nodes[2u * node + 1u].xyz = floatBitsToUint(box.upper);
}

NodeBox load_box(const uint node) {
    return NodeBox(uintBitsToFloat(nodes[2u * node].xyz), uintBitsToFloat(nodes[2u * node + 1u].xyz));
}

/// The box of `node`, if it is a leaf; returns how many it was.
uint bound_leaf(const uint node) {
    uint word = nodes[2u * node + 1u].w;
    if (!is_leaf_word(word)) return 0u;
    store_box(node, join_primitives(nodes[2u * node].w, get_word_count(word)));
    return 1u;
}

/// Levels below `node`.
uint find_height(const uint node) {
    return is_leaf_word(nodes[2u * node + 1u].w) ? 0u : heights[(nodes[2u * node].w - 1u) / 2u];
}

/// A pair whose boxes are done; returns the pair of their parent, kNoNode at the root.
uint bound_parent(const uint pair) {
    uint left = 1u + 2u * pair;
    uint parent = parents[left];
    store_box(parent, join_boxes(load_box(left), load_box(left + 1u)));
    heights[pair] = 1u + max(find_height(left), find_height(left + 1u));
    if (parent == 0u) state.depth = heights[pair];
    return parent == 0u ? kNoNode : (parent - 1u) / 2u;
}

void main() {
    uint pair = invocation_index();
    uint cut_count = state.cut_count;
    uint arrived = 0u;
    if (cut_count == 0u && pair == 0u) bound_leaf(0u);
    if (pair < cut_count) arrived = bound_leaf(1u + 2u * pair) + bound_leaf(2u + 2u * pair);
    while (arrived > 0u) {
        memoryBarrierBuffer(); // what was stored is there before the arrival is
        bool is_complete = atomicAdd(arrivals[pair], arrived) + arrived == 2u;
        memoryBarrierBuffer(); // and the sibling's is read after its arrival
        arrived = 0u;
        if (is_complete) {
            pair = bound_parent(pair);
            arrived = pair == kNoNode ? 0u : 1u;
        }
    }
}
