#include "engine/vulkan/device_walk_trees.h"

#include <cstring>

namespace relief::vulkan {

namespace {

using scalar::WalkTreeData;
static_assert(sizeof(WalkTreeData) == scalar::kWalkTreeWords * sizeof(uint32_t));
static_assert(sizeof(scalar::KdBox) == sizeof(NodeTexels) && sizeof(TreeNode) == sizeof(NodeTexels));

/// Copies anything made of words to the end; returns its first word.
template <class T> uint32_t append_words(const std::vector<T>& values, std::vector<uint32_t>& words) {
    static_assert(sizeof(T) % sizeof(uint32_t) == 0);
    const size_t first = words.size();
    words.resize(first + values.size() * sizeof(T) / sizeof(uint32_t));
    if (!values.empty()) std::memcpy(words.data() + first, values.data(), values.size() * sizeof(T));
    return uint32_t(first);
}

/// The same for records of the size of a node.
template <class T> uint32_t append_nodes(const std::vector<T>& values, std::vector<NodeTexels>& nodes) {
    static_assert(sizeof(T) == sizeof(NodeTexels));
    const size_t first = nodes.size();
    nodes.resize(first + values.size());
    if (!values.empty()) std::memcpy(nodes.data() + first, values.data(), values.size() * sizeof(T));
    return uint32_t(first);
}

uint32_t append_boxes(const std::vector<Box>& boxes, std::vector<NodeTexels>& nodes) {
    const uint32_t first = uint32_t(nodes.size());
    for (const Box& box : boxes) nodes.push_back({box.lower, 0, box.upper, 0});
    return first;
}

WalkTreeData append_tree(const WalkTree& tree, TraversalKind traversal, std::vector<NodeTexels>& nodes,
                         std::vector<uint32_t>& words) {
    WalkTreeData data{};
    data.is_empty = tree.bounds.is_empty();
    if (data.is_empty) return data;
    switch (traversal) {
    case TraversalKind::trail:
    case TraversalKind::pair_trail:
        data.nodes = append_nodes(tree.heap.nodes, nodes);
        data.ids = append_words(tree.heap.primitive_ids, words);
        data.links = append_words(tree.heap.blocks, words);
        data.bricks = append_words(tree.heap.bricks, words);
        data.flat_levels = tree.heap.form.flat_levels, data.flat_pairs = tree.heap.form.flat_pairs;
        break;
    case TraversalKind::restart:
    case TraversalKind::push_down:
    case TraversalKind::backtrack:
        data.lower = tree.kd.bounds.lower, data.upper = tree.kd.bounds.upper;
        data.nodes = append_nodes(tree.kd.cells, nodes);
        data.ids = append_words(tree.kd.primitive_ids, words);
        data.links = append_words(tree.kd.nodes, words);
        data.boxes = append_boxes(tree.boxes, nodes);
        break;
    default:
        data.nodes = append_nodes(tree.linked.nodes, nodes);
        data.ids = append_words(tree.linked.primitive_ids, words);
        if (traversal == TraversalKind::parent_link) data.links = append_words(tree.linked.parents, words);
        if (traversal == TraversalKind::skip_link) data.links = append_words(tree.linked.skips, words);
    }
    return data;
}

} // namespace

void append_walk_trees(const WalkTrees& trees, std::vector<NodeTexels>& nodes, std::vector<uint32_t>& words) {
    std::vector<WalkTreeData> records(1 + trees.surfaces.size());
    append_words(records, words); // their place; filled in below
    for (size_t s = 0; s < trees.surfaces.size(); ++s)
        records[1 + s] = append_tree(trees.surfaces[s], trees.traversal, nodes, words);
    records[0] = append_tree(trees.instances, trees.traversal, nodes, words);
    std::memcpy(words.data(), records.data(), records.size() * sizeof(WalkTreeData));
}

} // namespace relief::vulkan
