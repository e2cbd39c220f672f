#include "bvh/wide_children.h"

#include <algorithm>
#include <utility>

#include "bvh/sah_split.h"

namespace relief {

namespace {

/// What a node costs beside its visits: the root's area four times over, divided among the leaves. Patches
/// have some ten times that area each: it saves a twentieth of the nodes, and no ray notices.
constexpr float kNodeCost = 4;

} // namespace

WideCollapse::WideCollapse(const Bvh& bvh) : bvh_(bvh), costs_(bvh.nodes.size()) {
    std::vector<uint32_t> order{0};
    for (size_t k = 0; k < order.size(); ++k) {
        const BvhNode& node = bvh.nodes[order[k]];
        if (node.is_leaf())
            ++leaf_count_;
        else
            order.insert(order.end(), {node.first, node.first + 1});
    }
    node_cost_ = kNodeCost / float(leaf_count_);
    const double root_area = compute_half_area(bvh.nodes[0].box());
    if (root_area > 0) area_scale_ = 1 / root_area;
    for (size_t k = order.size(); k-- > 0;) find_costs(order[k]);
}

float WideCollapse::split_cost(uint32_t node, int slots, int left_slots) const {
    const uint32_t left = bvh_.nodes[node].first;
    return costs_[left][size_t(left_slots - 1)] + costs_[left + 1][size_t(slots - left_slots - 1)];
}

std::pair<int, float> WideCollapse::find_split(uint32_t node, int slots) const {
    std::pair<int, float> best{1, split_cost(node, slots, 1)};
    for (int left_slots = 2; left_slots < slots; ++left_slots) {
        const float cost = split_cost(node, slots, left_slots);
        if (cost < best.second) best = {left_slots, cost};
    }
    return best;
}

void WideCollapse::find_costs(uint32_t node) {
    Costs& costs = costs_[node];
    costs.fill(0);
    if (bvh_.nodes[node].is_leaf()) return;
    const float area = float(compute_half_area(bvh_.nodes[node].box()) * area_scale_);
    costs[0] = node_cost_ + area + find_split(node, kMaxWideChildCount).second;
    for (int slots = 2; slots < kMaxWideChildCount; ++slots)
        costs[size_t(slots - 1)] = std::min(costs[size_t(slots - 2)], find_split(node, slots).second);
}

void WideCollapse::collect(uint32_t node, int slots, WideChildren& list) const {
    const bool is_leaf = bvh_.nodes[node].is_leaf();
    if (is_leaf || slots == 1 || costs_[node][0] <= find_split(node, slots).second)
        list.nodes[size_t(list.count++)] = node;
    else
        open(node, slots, list);
}

void WideCollapse::open(uint32_t node, int slots, WideChildren& list) const {
    const int left_slots = find_split(node, slots).first;
    collect(bvh_.nodes[node].first, left_slots, list);
    collect(bvh_.nodes[node].first + 1, slots - left_slots, list);
}

WideChildren WideCollapse::collect_children(uint32_t root) const {
    WideChildren list;
    if (bvh_.nodes[root].is_leaf())
        list.nodes[0] = root, list.count = 1;
    else
        open(root, kMaxWideChildCount, list);
    return list;
}

} // namespace relief
