#include "bvh/wide_bvh.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bvh/wide_children.h"
#include "bvh/wide_encode.h"
#include "relief/error.h"

namespace relief {

namespace {

class Collapse {
  public:
    explicit Collapse(const Bvh& bvh) : bvh_(bvh), collapse_(bvh) {}

    WideBvh run() {
        wide_.bounds = bvh_.nodes[0].box();
        const bool has_single_leaves =
            std::all_of(bvh_.nodes.begin(), bvh_.nodes.end(),
                        [](const BvhNode& node) { return node.primitive_count <= 1; });
        if (!has_single_leaves) wide_.primitive_ids = bvh_.primitive_ids;
        wide_.nodes.resize(1);
        pending_.push_back({0, 0});
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            make_node(next);
        }
        wide_.nodes.shrink_to_fit();
        return std::move(wide_);
    }

  private:
    struct Pending {
        uint32_t binary_node;
        uint32_t wide_node;
    };

    void make_node(const Pending& pending) {
        const WideChildren list = collapse_.collect_children(pending.binary_node);
        WideNode node{};
        node.child_count = uint8_t(list.count);
        std::fill(std::begin(node.child), std::end(node.child), WideNode::kNoChild);
        std::array<Box, 8> boxes;
        for (int k = 0; k < list.count; ++k) {
            const BvhNode& source = bvh_.nodes[list.nodes[k]];
            boxes[k] = source.box();
            node.child[k] = source.is_leaf() ? make_leaf_child(source) : allocate(list.nodes[k]);
        }
        encode_boxes(node, bvh_.nodes[pending.binary_node].box(), boxes);
        wide_.nodes[pending.wide_node] = node;
    }

    uint32_t make_leaf_child(const BvhNode& leaf) const {
        const uint32_t first = wide_.primitive_ids.empty() ? bvh_.primitive_ids[leaf.first] : leaf.first;
        return WideNode::make_leaf(first, leaf.primitive_count);
    }

    uint32_t allocate(uint32_t binary_node) {
        const uint32_t index = uint32_t(wide_.nodes.size());
        wide_.nodes.emplace_back();
        pending_.push_back({binary_node, index});
        return index;
    }

    const Bvh& bvh_;
    const WideCollapse collapse_;
    WideBvh wide_;
    std::vector<Pending> pending_;
};

} // namespace

WideBvh make_wide_bvh(const Bvh& bvh) {
    if (bvh.nodes.empty()) return {};
    if (bvh.primitive_ids.size() > size_t(WideNode::kMaxLeafFirst) + 1)
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("{} primitives are too many, room is for 2^28", bvh.primitive_ids.size()),
             "wide BVH",
             "choose a traversal that walks the binary tree, or split the scene into instances of several "
             "meshes"});
    return Collapse(bvh).run();
}

} // namespace relief
