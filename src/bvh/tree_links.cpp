#include "bvh/tree_links.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/tree.h"

namespace relief {

namespace {

constexpr size_t kGrain = 16384;
constexpr size_t kSubtreeCount = 256;

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

/// Of the subtree at `root`, counted as its depth is.
int find_deepest(const Bvh& bvh, const Place& root) {
    int deepest = root.depth;
    std::vector<Place> pending{root};
    while (!pending.empty()) {
        const Place place = pending.back();
        pending.pop_back();
        deepest = std::max(deepest, place.depth);
        const BvhNode& node = bvh.nodes[place.node];
        if (node.is_leaf()) continue;
        pending.push_back({node.first, place.depth + 1});
        pending.push_back({node.first + 1, place.depth + 1});
    }
    return deepest;
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

LinkedBvh make_linked_bvh(const AxisBvh& tree) {
    const std::vector<BvhNode>& nodes = tree.bvh.nodes;
    DCHECK(tree.axes.size() == nodes.size());
    LinkedBvh result;
    result.primitive_ids = tree.bvh.primitive_ids;
    result.depth = tree.depth;
    result.nodes.resize(nodes.size());
    result.parents.assign(nodes.size(), scalar::kNoNode);
    result.skips.assign(nodes.size(), scalar::kNoNode);
    parallel_for("links", nodes.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            result.nodes[k] = std::bit_cast<TreeNode>(nodes[k]);
            if (nodes[k].is_leaf()) continue;
            result.nodes[k].word = scalar::make_inner_word(tree.axes[k]);
            const uint32_t left = nodes[k].first, right = left + 1;
            result.parents[left] = result.parents[right] = uint32_t(k);
            result.skips[left] = right;
        }
    });
    // The right children below a left one, or below the root, share its skip.
    parallel_for("skips", nodes.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            if (k > 0 && nodes[result.parents[k]].first != k) continue;
            for (size_t node = k; !nodes[node].is_leaf(); node = nodes[node].first + 1)
                result.skips[nodes[node].first + 1] = result.skips[k];
        }
    });
    return result;
}

int compute_depth(const Bvh& bvh) {
    if (bvh.nodes.empty()) return 0;
    // Subtrees below a few levels, each for one thread.
    std::vector<Place> roots{{0, 0}};
    for (size_t before = 0; before < roots.size() && roots.size() < kSubtreeCount;) {
        before = roots.size();
        for (size_t k = 0; k < before; ++k) {
            const auto [node, depth] = roots[k];
            if (bvh.nodes[node].is_leaf()) continue;
            roots[k] = {bvh.nodes[node].first, depth + 1};
            roots.push_back({bvh.nodes[node].first + 1, depth + 1});
        }
    }
    std::vector<int> depths(roots.size());
    parallel_for("depth", roots.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) depths[k] = find_deepest(bvh, roots[k]);
    });
    return *std::max_element(depths.begin(), depths.end());
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
    const int depth = compute_depth(bvh);
    return {std::move(bvh), std::move(axes), depth};
}

AxisBvh limit_depth(AxisBvh tree, int max_depth) {
    if (tree.depth <= max_depth) return tree;
    return add_axes(limit_depth(tree.bvh, max_depth));
}

} // namespace relief
