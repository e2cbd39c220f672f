// Which nodes of a binary tree become the children of one eight-wide node: the same for every wide layout.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bvh/bvh.h"

namespace relief {

inline constexpr int kMaxWideChildCount = 8;

/// What the words mean that name the children of a wide node, in every layout.
struct WideChild {
    static constexpr uint32_t kLeafFlag =
        0x80000000u; ///< then bits 28..30: primitives - 1, bits 0..27: first
    static constexpr uint32_t kNoChild = 0xffffffffu;
    static constexpr uint32_t kMaxLeafFirst = 0x0fffffffu;

    /// Not for kNoChild.
    static bool is_leaf(uint32_t child) { return (child & kLeafFlag) != 0; }
    static uint32_t leaf_first(uint32_t child) { return child & kMaxLeafFirst; }
    static uint32_t leaf_count(uint32_t child) { return ((child >> 28) & 7) + 1; }
    /// `first` <= kMaxLeafFirst, `count` in [1, 8].
    static uint32_t make_leaf(uint32_t first, uint32_t count) {
        return kLeafFlag | (count - 1) << 28 | first;
    }
};

/// A wide node before it has a layout; slots from `count` on have empty boxes and kNoChild.
struct WideNodeParts {
    Box bounds;
    int count = 0;
    std::array<Box, kMaxWideChildCount> boxes{};
    std::array<uint32_t, kMaxWideChildCount> child{};
};

/// Up to eight nodes of the binary tree, in its order.
struct WideChildren {
    std::array<uint32_t, kMaxWideChildCount> nodes{};
    int count = 0;
};

/// The wide nodes of least area in all, found from the leaves upwards (Ylitie, Karras, Laine 2017, section
/// 3.1; a node costs its area, and a little more, however many children it has; leaves cost nothing).
class WideCollapse {
  public:
    /// `bvh` outlives this and has a node. Children may come before or after their parents in memory.
    explicit WideCollapse(const Bvh& bvh);

    /// Children of the wide node whose box is that of `root`. A root that is a leaf is its own only child.
    WideChildren collect_children(uint32_t root) const;

    uint32_t leaf_count() const { return leaf_count_; }
    /// What a node costs beside its share of the root's area.
    float node_cost() const { return node_cost_; }

  private:
    /// [k]: of the wide nodes that a subtree is, if it takes at most k + 1 slots of the one above.
    using Costs = std::array<float, kMaxWideChildCount - 1>;

    float split_cost(uint32_t node, int slots, int left_slots) const;
    /// Slots that the left child gets of those of its parent, and what that costs.
    std::pair<int, float> find_split(uint32_t node, int slots) const;
    void find_costs(uint32_t node);
    /// Appends what a subtree puts into `slots` slots: itself, or what is below it.
    void collect(uint32_t node, int slots, WideChildren& list) const;
    void open(uint32_t node, int slots, WideChildren& list) const;

    const Bvh& bvh_;
    std::vector<Costs> costs_;
    uint32_t leaf_count_ = 0;
    double area_scale_ = 0; ///< so that the root has 1
    float node_cost_ = 0;
};

/// The wide nodes that `collapse` cuts `bvh` into, node 0 the root; inner children of a node are adjacent and
/// behind it. make_leaf(binary leaf) gives child words, encode(parts) nodes.
template <class Nodes, class MakeLeaf, class Encode>
void make_wide_nodes(const Bvh& bvh, const WideCollapse& collapse, Nodes& nodes, MakeLeaf make_leaf,
                     Encode encode) {
    struct Pending {
        uint32_t binary_node, node;
    };
    std::vector<Pending> pending{{0, 0}};
    nodes.resize(1);
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const WideChildren list = collapse.collect_children(next.binary_node);
        WideNodeParts parts{bvh.nodes[next.binary_node].box(), list.count, {}, {}};
        parts.child.fill(WideChild::kNoChild);
        for (size_t k = 0; k < size_t(list.count); ++k) {
            const BvhNode& source = bvh.nodes[list.nodes[k]];
            parts.boxes[k] = source.box();
            if (source.is_leaf()) {
                parts.child[k] = make_leaf(source);
                continue;
            }
            parts.child[k] = uint32_t(nodes.size());
            pending.push_back({list.nodes[k], uint32_t(nodes.size())});
            nodes.emplace_back();
        }
        nodes[next.node] = encode(parts);
    }
    nodes.shrink_to_fit();
}

} // namespace relief
