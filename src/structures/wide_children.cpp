#include "structures/wide_children.h"

#include <algorithm>

#include "structures/sah_split.h"

namespace relief {

namespace {

/// The child to open next, -1: none. Subtrees that fit one wide node are opened only where that takes them in
/// whole: otherwise the lowest level, which is most of the tree, would be left with half-empty nodes.
int choose_child_to_open(const Bvh& bvh, std::span<const uint32_t> leaf_counts, const WideChildren& list) {
    const uint32_t free_slots = uint32_t(kMaxWideChildCount - list.count);
    int best = -1;
    bool is_best_large = false;
    double best_area = -1;
    for (int k = 0; k < list.count; ++k) {
        const BvhNode& node = bvh.nodes[list.nodes[k]];
        const uint32_t leaves = leaf_counts[list.nodes[k]];
        const bool is_large = leaves > uint32_t(kMaxWideChildCount);
        if (node.is_leaf() || (!is_large && leaves - 1 > free_slots) || (is_best_large && !is_large))
            continue;
        const double area = compute_half_area(node.box());
        if (area > best_area || (is_large && !is_best_large))
            best = k, best_area = area, is_best_large = is_large;
    }
    return best;
}

} // namespace

std::vector<uint32_t> count_leaves(const Bvh& bvh) {
    std::vector<uint32_t> order{0};
    for (size_t k = 0; k < order.size(); ++k) {
        const BvhNode& node = bvh.nodes[order[k]];
        if (!node.is_leaf()) order.insert(order.end(), {node.first, node.first + 1});
    }
    std::vector<uint32_t> counts(bvh.nodes.size(), 1);
    for (size_t k = order.size(); k-- > 0;) {
        const BvhNode& node = bvh.nodes[order[k]];
        if (!node.is_leaf()) counts[order[k]] = counts[node.first] + counts[node.first + 1];
    }
    return counts;
}

WideChildren collect_wide_children(const Bvh& bvh, std::span<const uint32_t> leaf_counts, uint32_t root) {
    WideChildren list;
    list.nodes[0] = root;
    list.count = 1;
    while (list.count < kMaxWideChildCount) {
        const int opened = choose_child_to_open(bvh, leaf_counts, list);
        if (opened < 0) break;
        const uint32_t first = bvh.nodes[list.nodes[opened]].first;
        std::copy_backward(list.nodes.begin() + opened + 1, list.nodes.begin() + list.count,
                           list.nodes.begin() + list.count + 1);
        list.nodes[opened] = first;
        list.nodes[opened + 1] = first + 1;
        ++list.count;
    }
    return list;
}

} // namespace relief
