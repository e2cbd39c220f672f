#include "bvh/wide_refit.h"

#include <array>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "bvh/wide_encode.h"

namespace relief {

namespace {

bool has_moved_leaf(const WideBvh& tree, const WideNode& node, std::span<const uint8_t> is_moved) {
    for (int k = 0; k < node.child_count; ++k)
        if (WideNode::is_leaf(node.child[k]) &&
            is_moved[tree.primitive_at(WideNode::leaf_first(node.child[k]))])
            return true;
    return false;
}

Box join_children(const WideNode& node) {
    Box box;
    for (int k = 0; k < node.child_count; ++k) box.extend(node.child_box(k));
    return box;
}

/// New boxes of the leaves of a node, of all: those that have not moved are known by their codes only, and
/// codes rounded over and over would grow.
std::array<Box, 8> find_leaf_boxes(const WideBvh& tree, const WideNode& node,
                                   const std::function<Box(uint32_t)>& find_box) {
    std::array<Box, 8> boxes;
    for (int k = 0; k < node.child_count; ++k)
        if (WideNode::is_leaf(node.child[k]))
            boxes[k] = find_box(tree.primitive_at(WideNode::leaf_first(node.child[k])));
    return boxes;
}

} // namespace

void refit_wide_bvh(WideBvh& tree, std::span<const uint8_t> is_moved,
                    const std::function<Box(uint32_t primitive)>& find_box) {
    // Children lie behind their parents, so that going backwards meets them first.
    std::vector<uint8_t> has_changed(tree.nodes.size());
    std::vector<uint32_t> changed;
    for (size_t index = tree.nodes.size(); index-- > 0;) {
        const WideNode& node = tree.nodes[index];
        has_changed[index] = has_moved_leaf(tree, node, is_moved);
        for (int k = 0; k < node.child_count; ++k) {
            DCHECK(WideNode::is_leaf(node.child[k]) || node.child[k] > index);
            if (!WideNode::is_leaf(node.child[k])) has_changed[index] |= has_changed[node.child[k]];
        }
        if (has_changed[index]) changed.push_back(uint32_t(index));
    }
    std::vector<std::array<Box, 8>> boxes(changed.size());
    parallel_for("boxes of a refit", changed.size(), 4, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            boxes[k] = find_leaf_boxes(tree, tree.nodes[changed[k]], find_box);
    });
    Box bounds = tree.bounds;
    for (size_t at = 0; at < changed.size(); ++at) {
        WideNode& node = tree.nodes[changed[at]];
        bounds = {};
        for (int k = 0; k < node.child_count; ++k) {
            if (!WideNode::is_leaf(node.child[k])) boxes[at][k] = join_children(tree.nodes[node.child[k]]);
            bounds.extend(boxes[at][k]);
        }
        encode_boxes(node, bounds, boxes[at]);
    }
    tree.bounds = bounds; // the root is the last one
}

} // namespace relief
