#include "bvh/wide_bvh.h"

#include <algorithm>

#include <fmt/format.h>

#include "bvh/wide_encode.h"
#include "relief/error.h"

namespace relief {

WideBvh make_wide_bvh(const Bvh& bvh) {
    if (bvh.nodes.empty()) return {};
    if (bvh.primitive_ids.size() > size_t(WideNode::kMaxLeafFirst) + 1)
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("{} primitives are too many, room is for 2^28", bvh.primitive_ids.size()),
             "wide BVH",
             "choose a traversal that walks the binary tree, or split the scene into instances of several "
             "meshes"});
    WideBvh wide;
    wide.bounds = bvh.nodes[0].box();
    const bool has_single_leaves = std::all_of(bvh.nodes.begin(), bvh.nodes.end(),
                                               [](const BvhNode& node) { return node.primitive_count <= 1; });
    if (!has_single_leaves) wide.primitive_ids = bvh.primitive_ids;
    const auto make_leaf = [&](const BvhNode& leaf) {
        const uint32_t first = has_single_leaves ? bvh.primitive_ids[leaf.first] : leaf.first;
        return WideNode::make_leaf(first, leaf.primitive_count);
    };
    make_wide_nodes(bvh, WideCollapse(bvh), wide.nodes, make_leaf, encode_node);
    return wide;
}

} // namespace relief
