// Nodes with up to eight children in boxes of eight bits (bvh/wide_bvh.h), and the stack of those that are entered. The
// stack holds a node once, with the children that are left: it is as deep as the tree.
#ifndef RELIEF_WIDE_NODES_GLSL
#define RELIEF_WIDE_NODES_GLSL

#include "formulas/quantise.h"
#include "vulkan/shaders/scene_candidates.glsl"

layout(constant_id = 1) const uint kStackSize = 32;

/// A node, a bit for each child that is left, the bits of the node's entry.
uvec3 stack[kStackSize];
uint stack_size = 0u;

/// What the boxes of a node's children share.
struct NodeGrid {
    vec3 origin, scale;
    uint child_count;
};

float decode_node_scale(const uint exponents, const int axis) {
    return uintBitsToFloat(uint(bitfieldExtract(int(exponents), 8 * axis, 8) + 127) << 23u);
}

NodeGrid load_grid(const uint node) {
    uvec4 head = texelFetch(nodes, int(2u * node));
    vec3 scale = vec3(decode_node_scale(head.w, 0), decode_node_scale(head.w, 1), decode_node_scale(head.w, 2));
    return NodeGrid(uintBitsToFloat(head.xyz), scale, head.w >> 24u);
}

/// The codes of four children, an axis a word.
struct BoxCodes {
    uvec3 lower, upper;
};

/// Of slots 0 to 3 or 4 to 7.
BoxCodes load_codes(const uint node, const uint half_index) {
    int place = int(2u * node);
    uvec4 a = texelFetch(nodes, place + 1), b = texelFetch(nodes, place + 2), c = texelFetch(nodes, place + 3);
    return half_index == 0u ? BoxCodes(uvec3(a.x, a.z, b.x), uvec3(b.z, c.x, c.z))
                            : BoxCodes(uvec3(a.y, a.w, b.y), uvec3(b.w, c.y, c.w));
}

vec3 decode_corner(const NodeGrid grid, const uvec3 codes, const uint slot) {
    int first_bit = int(8u * (slot & 3u));
    return vec3(decode_bound(grid.origin.x, grid.scale.x, bitfieldExtract(codes.x, first_bit, 8)),
                decode_bound(grid.origin.y, grid.scale.y, bitfieldExtract(codes.y, first_bit, 8)),
                decode_bound(grid.origin.z, grid.scale.z, bitfieldExtract(codes.z, first_bit, 8)));
}

BoxInterval cross_child(const NodeGrid grid, const BoxCodes codes, const uint slot) {
    return cross_box(ray, decode_corner(grid, codes.lower, slot), decode_corner(grid, codes.upper, slot), ray_t_min,
                     ray_t_max);
}

uint load_child(const uint node, const uint slot) {
    uvec4 words = texelFetch(nodes, int(2u * node + 4u + (slot >> 2u)));
    return words[slot & 3u];
}

/// Puts a node whose children are wanted onto the stack; `node_entry` is its own.
void enter_node(const uint node, const float node_entry) {
    NodeGrid grid = load_grid(node);
    uint wanted = 0u;
    [[dont_unroll]] for (uint slot = 0u; slot < grid.child_count; ++slot) {
        BoxInterval interval = cross_child(grid, load_codes(node, slot >> 2u), slot);
        if (is_wanted(interval, max(interval.entry, node_entry))) wanted |= 1u << slot;
    }
    if (wanted == 0u) return;
    stack[stack_size] = uvec3(node, wanted, floatBitsToUint(node_entry));
    ++stack_size;
}

/// A child from the top of the stack.
struct NextChild {
    uint word; ///< kNone: no longer wanted, nor is what else the node had
    float entry;
};

/// The nearest child that is left, with the stack not empty. To look at their boxes again takes fewer registers than to
/// keep their entries.
NextChild take_child() {
    uvec3 top = stack[stack_size - 1u];
    NodeGrid grid = load_grid(top.x);
    NextChild next = NextChild(kNone, kInfinity);
    uint nearest = findLSB(top.y);
    [[dont_unroll]] for (uint left = top.y; left != 0u; left &= left - 1u) {
        uint slot = findLSB(left);
        float entry = max(cross_child(grid, load_codes(top.x, slot >> 2u), slot).entry, uintBitsToFloat(top.z));
        if (entry < next.entry) {
            next.entry = entry;
            nearest = slot;
        }
    }
    uint others = top.y & ~(1u << nearest);
    bool is_wanted_still = next.entry <= find_limit();
    if (is_wanted_still) next.word = load_child(top.x, nearest);
    if (others == 0u || !is_wanted_still)
        --stack_size;
    else
        stack[stack_size - 1u].y = others;
    return next;
}

#endif
