// Shared by the linear builders: sorted codes, and where a range is cut, by the rule of lab/trees/lbvh.h.
#include "formulas/lang.h"
#include "formulas/constants.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "formulas/quantise.h"
#include "formulas/morton.h"
#include "lab/walks/trail.h"
#include "formulas/tree.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_trees.h"

layout(constant_id = 1) const uint kCodeBits = 30u; ///< 30 or 63

layout(scalar, push_constant) uniform Push { BuildPush push; };
layout(scalar, set = 0, binding = kBindBuildState) buffer State { BuildState state; };
layout(scalar, set = 0, binding = kBindBuildBoxes) buffer Boxes { float boxes[]; };
layout(set = 0, binding = kBindPairs) buffer Pairs { uvec2 pairs[]; };             ///< (code, primitive), sorted
layout(set = 0, binding = kBindSortedPairs) buffer SortedCodes { uvec2 sorted_codes[]; }; ///< of 63 bits

struct NodeBox {
    vec3 lower, upper;
};

NodeBox load_primitive_box(const uint primitive) {
    uint first = 6u * primitive;
    return NodeBox(vec3(boxes[first], boxes[first + 1u], boxes[first + 2u]),
                   vec3(boxes[first + 3u], boxes[first + 4u], boxes[first + 5u]));
}

float get_lesser(const float a, const float b) { return a < b ? a : b; }
float get_greater(const float a, const float b) { return a > b ? a : b; }

NodeBox join_boxes(const NodeBox a, const NodeBox b) {
    return NodeBox(
        vec3(get_lesser(a.lower.x, b.lower.x), get_lesser(a.lower.y, b.lower.y), get_lesser(a.lower.z, b.lower.z)),
        vec3(get_greater(a.upper.x, b.upper.x), get_greater(a.upper.y, b.upper.y), get_greater(a.upper.z, b.upper.z)));
}

/// Of entries [first, first + count).
NodeBox join_primitives(const uint first, const uint count) {
    NodeBox all = NodeBox(vec3(make_infinity()), vec3(-make_infinity()));
    uint done = 0u;
    for (; done < count; ++done) all = join_boxes(all, load_primitive_box(pairs[first + done].y));
    if (done != count) atomicAdd(state.loops_ended, 1u);
    return all;
}

HeapKey load_code(const uint entry) {
    if (kCodeBits == 30u) return HeapKey(pairs[entry].x, 0u);
    uvec2 code = sorted_codes[entry];
    return HeapKey(code.x, code.y);
}

/// Bits in which two codes or numbers differ.
HeapKey differ_bits(const HeapKey a, const HeapKey b) { return HeapKey(a.low ^ b.low, a.high ^ b.high); }

/// First entry of [first, last] with bit `bit` of its code set; the last one has it, the first has not.
uint find_bit(uint first, uint last, const uint bit) {
    while (last - first > 1u) {
        uint middle = first + (last - first) / 2u;
        if ((get_low_word(shift_right(load_code(middle), bit)) & 1u) != 0u)
            last = middle;
        else
            first = middle;
    }
    return last;
}

struct Cut {
    uint entry; ///< the right child starts here
    uint axis;
};

/// Of entries [first, last] whose codes are not all equal.
Cut cut_by_code(const uint first, const uint last) {
    uint bit = get_key_level(differ_bits(load_code(first), load_code(last)));
    return Cut(find_bit(first, last, bit), axis_of_morton_bit(bit));
}

/// Of entries of equal codes.
Cut cut_by_number(const uint first, const uint last) {
    uint bit = get_key_level(first ^ last);
    return Cut((last >> bit) << bit, 0u);
}
