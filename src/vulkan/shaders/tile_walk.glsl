// The walk through the tree over the tiles of a patch, whose nodes are binary; the nearer child is pushed last.
#ifndef RELIEF_TILE_WALK_GLSL
#define RELIEF_TILE_WALK_GLSL

#include "vulkan/shaders/scene_candidates.glsl"

layout(constant_id = kTileStackConstant) const uint kTileStackSize = 1;

/// Nodes and the bits of their entries, in one array: drivers keep small ones in registers, where an index that varies
/// costs a comparison an entry.
uvec2 tile_stack[kTileStackSize];
uint tile_stack_size = 0u;

void push_node(const uint node, const float entry) {
    tile_stack[tile_stack_size] = uvec2(node, floatBitsToUint(entry));
    ++tile_stack_size;
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

void enter_tiles(const uint root, const float entry) {
    push_node(root, entry);
    while (tile_stack_size > 0u) {
        --tile_stack_size;
        uvec2 top = tile_stack[tile_stack_size];
        float node_entry = uintBitsToFloat(top.y);
        if (node_entry <= find_limit()) {
            uint first = texelFetch(nodes, 2 * int(top.x)).w;
            if (texelFetch(nodes, 2 * int(top.x) + 1).w >> kNodeKindShift == kNodeInner)
                enter_inner(first, node_entry);
            else
                offer_candidate(first, node_entry);
        }
    }
}

#endif
