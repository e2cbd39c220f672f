#include "structures/tree_links.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "base/parallel.h"

namespace relief {

namespace {

constexpr size_t kGrain = 16384;

struct Place {
    uint32_t node;
    int depth;
};

uint8_t choose_axis(const BvhNode& left, const BvhNode& right) {
    int best = 0;
    double widest = -std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const auto middle = [&](const BvhNode& node) {
            return double(get_component(node.lower, axis)) + get_component(node.upper, axis);
        };
        const double step = middle(right) - middle(left);
        if (step > widest) widest = step, best = axis;
    }
    return uint8_t(best);
}

} // namespace

std::vector<uint8_t> compute_axes(const Bvh& bvh) {
    std::vector<uint8_t> axes(bvh.nodes.size());
    parallel_for("axes", bvh.nodes.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const BvhNode& node = bvh.nodes[k];
            if (!node.is_leaf()) axes[k] = choose_axis(bvh.nodes[node.first], bvh.nodes[node.first + 1]);
        }
    });
    return axes;
}

LinkedBvh make_linked_bvh(const Bvh& bvh, std::span<const uint8_t> axes) {
    DCHECK(axes.size() == bvh.nodes.size());
    LinkedBvh result;
    const size_t count = bvh.nodes.size();
    result.primitive_ids = bvh.primitive_ids;
    result.nodes.resize(count);
    result.parents.assign(count, scalar::kNoNode);
    result.skips.assign(count, scalar::kNoNode);
    if (count == 0) return result;
    std::vector<Place> pending{{0, 0}};
    while (!pending.empty()) {
        const Place place = pending.back();
        pending.pop_back();
        const BvhNode& node = bvh.nodes[place.node];
        result.nodes[place.node] = std::bit_cast<TreeNode>(node);
        result.depth = std::max(result.depth, place.depth);
        if (node.is_leaf()) continue;
        result.nodes[place.node].word = scalar::make_inner_word(axes[place.node]);
        const uint32_t left = node.first, right = node.first + 1;
        result.parents[left] = result.parents[right] = place.node;
        result.skips[left] = right;
        result.skips[right] = result.skips[place.node];
        pending.push_back({right, place.depth + 1});
        pending.push_back({left, place.depth + 1});
    }
    return result;
}

int compute_depth(const Bvh& bvh) {
    if (bvh.nodes.empty()) return 0;
    int depth = 0;
    std::vector<Place> pending{{0, 0}};
    while (!pending.empty()) {
        const Place place = pending.back();
        pending.pop_back();
        depth = std::max(depth, place.depth);
        const BvhNode& node = bvh.nodes[place.node];
        if (node.is_leaf()) continue;
        pending.push_back({node.first, place.depth + 1});
        pending.push_back({node.first + 1, place.depth + 1});
    }
    return depth;
}

namespace {

/// Entries of primitive_ids below a node.
struct EntryRange {
    uint32_t begin, end;
};

EntryRange find_entries(const Bvh& bvh, uint32_t root) {
    EntryRange range{0xffffffffu, 0};
    uint32_t count = 0;
    std::vector<uint32_t> pending{root};
    while (!pending.empty()) {
        const BvhNode& node = bvh.nodes[pending.back()];
        pending.pop_back();
        if (!node.is_leaf()) {
            pending.insert(pending.end(), {node.first, node.first + 1});
            continue;
        }
        range.begin = std::min(range.begin, node.first);
        range.end = std::max(range.end, node.first + node.primitive_count);
        count += node.primitive_count;
    }
    DCHECK(range.end - range.begin == count);
    return range;
}

} // namespace

Bvh limit_depth(const Bvh& bvh, int max_depth) {
    Bvh result;
    result.primitive_ids = bvh.primitive_ids;
    if (bvh.nodes.empty()) return result;
    struct Move {
        uint32_t from, to;
        int depth;
    };
    std::vector<Move> pending{{0, 0, 0}};
    result.nodes.resize(1);
    while (!pending.empty()) {
        const Move move = pending.back();
        pending.pop_back();
        BvhNode node = bvh.nodes[move.from];
        const uint32_t first = node.first;
        if (!node.is_leaf() && move.depth == max_depth) {
            const EntryRange entries = find_entries(bvh, move.from);
            node.first = entries.begin;
            node.primitive_count = entries.end - entries.begin;
        } else if (!node.is_leaf()) {
            node.first = uint32_t(result.nodes.size());
            result.nodes.resize(result.nodes.size() + 2);
            pending.push_back({first + 1, node.first + 1, move.depth + 1});
            pending.push_back({first, node.first, move.depth + 1});
        }
        result.nodes[move.to] = node;
    }
    return result;
}

AxisBvh add_axes(Bvh bvh) {
    std::vector<uint8_t> axes = compute_axes(bvh);
    return {std::move(bvh), std::move(axes)};
}

AxisBvh limit_depth(AxisBvh tree, int max_depth) {
    if (compute_depth(tree.bvh) <= max_depth) return tree;
    return add_axes(limit_depth(tree.bvh, max_depth));
}

} // namespace relief
