// Eight-wide BVH with 8-bit boxes, made from a binary one, for both engines (after Ylitie et al. 2017).
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/wide_children.h"

namespace relief {

/// 96 bytes. Child boxes are origin + code * 2^exponent, which is exact; codes are rounded outward. Children
/// fill the slots from 0; unused slots have lower > upper in x. Walkers must mask by child_count: a widened
/// slab test may still enter such slots.
struct WideNode : WideChild {
    static constexpr int kMaxChildCount = kMaxWideChildCount;

    float origin[3];
    int8_t exponent[3]; ///< [-126, 127]: a normal float
    uint8_t child_count;
    uint8_t planes[6][8]; ///< lower x y z, upper x y z
    uint32_t child[8];

    /// Box of child k < child_count; holds the original box.
    Box child_box(int k) const;

    static float decode_scale(int exponent) { return std::bit_cast<float>(uint32_t(exponent + 127) << 23); }
    static float decode(float origin, float scale, uint8_t code) { return origin + float(code) * scale; }
};
static_assert(sizeof(WideNode) == 96);

/// `leaf first` indexes primitive_ids, or is the primitive itself when primitive_ids is empty.
struct WideBvh {
    std::vector<WideNode> nodes; ///< node 0 is the root; empty: no primitives
    std::vector<uint32_t> primitive_ids;
    Box bounds; ///< exact union of the boxes that the binary tree was built from

    uint32_t primitive_at(uint32_t index) const {
        return primitive_ids.empty() ? index : primitive_ids[index];
    }
    size_t byte_count() const {
        return nodes.size() * sizeof(WideNode) + primitive_ids.size() * sizeof(uint32_t);
    }
};

/// Collapses the binary tree into the nodes of least area (bvh/wide_children.h).
/// Inner children of a node are adjacent. Throws Error for more than 2^28 primitives.
WideBvh make_wide_bvh(const Bvh& bvh);

/// Refits a tree of one primitive a leaf, shape kept. `is_moved`: a byte a primitive; `find_box` gives
/// current boxes, for several threads, also of some that have not moved. Boxes of the unmoved may come out
/// slightly larger, but do not grow from call to call.
void refit_wide_bvh(WideBvh& tree, std::span<const uint8_t> is_moved,
                    const std::function<Box(uint32_t primitive)>& find_box);

inline Box WideNode::child_box(int k) const {
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float scale = decode_scale(exponent[axis]);
        low[axis] = decode(origin[axis], scale, planes[axis][k]);
        high[axis] = decode(origin[axis], scale, planes[3 + axis][k]);
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

} // namespace relief
