// Which nodes of a binary tree become the children of one eight-wide node: the same for every wide layout.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bvh/bvh.h"

namespace relief {

inline constexpr int kMaxWideChildCount = 8;

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

} // namespace relief
