#include "engine/cpu/open_nodes.h"

#include <limits>

namespace relief::cpu {

namespace {

constexpr size_t kMostNodes = 4096; ///< 1 MiB: no more than a core keeps close

PolygonNode open_node(const WideNode& node) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    PolygonNode open;
    for (int k = 0; k < WideNode::kMaxChildCount; ++k) {
        const bool is_used = k < node.child_count;
        const Box box = node.child_box(k);
        for (int axis = 0; axis < 3; ++axis) {
            open.bounds[axis][k] = is_used ? get_component(box.lower, axis) : kInfinity;
            open.bounds[3 + axis][k] = is_used ? get_component(box.upper, axis) : -kInfinity;
        }
        open.child[k] = is_used ? node.child[k] : PolygonNode::kNoChild;
    }
    return open;
}

} // namespace

OpenNodes open_nodes(const WideBvh& tree) {
    OpenNodes nodes;
    if (tree.nodes.size() > kMostNodes) return nodes;
    nodes.reserve(tree.nodes.size());
    for (const WideNode& node : tree.nodes) nodes.push_back(open_node(node));
    return nodes;
}

} // namespace relief::cpu
