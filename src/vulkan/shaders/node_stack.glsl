// Traversal stack of nodes with their entry distances; the nearer child is pushed last.
#ifndef RELIEF_NODE_STACK_GLSL
#define RELIEF_NODE_STACK_GLSL

#include "vulkan/shaders/scene_candidates.glsl"

layout(constant_id = 1) const uint kStackSize = 128;

/// Nodes and the bits of their entries, in one array: drivers keep small ones in registers, where an index that varies
/// costs a comparison an entry.
uvec2 stack[kStackSize];
uint stack_size = 0u;

void push_node(const uint node, const float entry) {
    stack[stack_size] = uvec2(node, floatBitsToUint(entry));
    ++stack_size;
}

void enter_inner(const uint first, const float parent_entry) {
    float entry[2];
    bool wanted[2];
    for (int k = 0; k < 2; ++k) {
        int place = 2 * int(first) + 2 * k;
        vec3 lower = uintBitsToFloat(texelFetch(nodes, place).xyz);
        vec3 upper = uintBitsToFloat(texelFetch(nodes, place + 1).xyz);
        BoxInterval interval = cross_box(ray, lower, upper, ray_t_min, ray_t_max);
        entry[k] = max(interval.entry, parent_entry);
        wanted[k] = is_wanted(interval, entry[k]);
    }
    bool is_second_nearer = entry[1] < entry[0];
    uint near = is_second_nearer ? 1u : 0u;
    if (wanted[1u - near]) push_node(first + 1u - near, entry[1u - near]);
    if (wanted[near]) push_node(first + near, entry[near]);
}

#endif
