// One invocation per cut finds its node and writes both children (Karras 2012); boxes: lbvh_refit.comp.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildNumbers) readonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = kBindBuildNodes) writeonly buffer Nodes { uvec4 nodes[]; };
layout(set = 0, binding = kBindBuildParents) writeonly buffer Parents { uint parents[]; };
layout(set = 0, binding = kBindBuildSkips) writeonly buffer Skips { uint skips[]; };

/// What the entries of a node share: bits of the code from `bit` on; or the code, and bits of the number from there.
struct NodePrefix {
    HeapKey code;
    uint bit, number;
    bool is_by_number;
};

NodePrefix find_prefix(const uint cut) {
    HeapKey code = load_code(cut);
    HeapKey difference = differ_bits(load_code(cut - 1u), code);
    if (is_zero(difference)) {
        uint bit = count_trailing_zeros(cut) + 1u;
        return NodePrefix(code, bit, shift_right(cut, bit), true);
    }
    uint bit = get_key_level(difference) + 1u;
    return NodePrefix(shift_right(code, bit), bit, 0u, false);
}

bool is_inside(const uint entry, const NodePrefix prefix) {
    HeapKey code = load_code(entry);
    if (prefix.is_by_number) return is_equal(code, prefix.code) && shift_right(entry, prefix.bit) == prefix.number;
    return is_equal(shift_right(code, prefix.bit), prefix.code);
}

/// First entry of the node, at most `inside`.
uint find_first(uint inside, const NodePrefix prefix) {
    uint step = 1u;
    while (step <= inside && is_inside(inside - step, prefix)) {
        inside -= step;
        step *= 2u;
    }
    for (; step > 0u; step /= 2u)
        if (step <= inside && is_inside(inside - step, prefix)) inside -= step;
    return inside;
}

/// Last entry of the node, at least `inside`.
uint find_last(uint inside, const NodePrefix prefix) {
    uint count = push.primitive_count;
    uint step = 1u;
    while (step < count - inside && is_inside(inside + step, prefix)) {
        inside += step;
        step *= 2u;
    }
    for (; step > 0u; step /= 2u)
        if (step < count - inside && is_inside(inside + step, prefix)) inside += step;
    return inside;
}

/// Node of entries [first, last].
void write_node(const uint node, const uint first, const uint last) {
    bool is_one_code = is_equal(load_code(first), load_code(last));
    uint next = last + 1u;
    skips[node] = next < push.primitive_count ? 2u + 2u * numbers[next] : kNoNode;
    if (is_one_code && last - first < push.max_leaf_size) {
        nodes[2u * node] = uvec4(0u, 0u, 0u, first);
        nodes[2u * node + 1u] = uvec4(0u, 0u, 0u, last - first + 1u);
        return;
    }
    Cut cut = cut_by_number(first, last);
    if (!is_one_code) cut = cut_by_code(first, last);
    uint left = 1u + 2u * numbers[cut.entry];
    nodes[2u * node] = uvec4(0u, 0u, 0u, left);
    nodes[2u * node + 1u] = uvec4(0u, 0u, 0u, make_inner_word(cut.axis));
    parents[left] = node;
    parents[left + 1u] = node;
}

void main() {
    uint cut = invocation_index();
    if (cut >= push.primitive_count) return;
    if (cut == 0u) {
        parents[0] = kNoNode;
        write_node(0u, 0u, push.primitive_count - 1u);
        return;
    }
    uint number = numbers[cut];
    if (numbers[cut + 1u] == number) return;
    NodePrefix prefix = find_prefix(cut);
    write_node(1u + 2u * number, find_first(cut - 1u, prefix), cut - 1u);
    write_node(2u + 2u * number, cut, find_last(cut, prefix));
}
